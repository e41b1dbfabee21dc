#include "orchestrator/player.hpp"

#include "protocol/version.hpp"

namespace duet::orchestrator {

std::string name_of(const Player& player) {
    return "the " + protocol::name_of(player.role);
}

} // namespace duet::orchestrator
