#include "orchestrator/failure.hpp"

#include "orchestrator/schema.hpp"

namespace duet::orchestrator {

namespace {

std::string when_text(const When& when) {
    if (!when.window)
        return "before the first window";
    return "in window " + std::to_string(*when.window) + " (t = " + number_text(when.time) + " s)";
}

} // namespace

Failure::Failure(const std::string& who, const When& when, const std::string& what, bool direct)
    : std::runtime_error(who + " failed " + when_text(when) + ": " + what), who_(who),
      sentence_(what), when_(when), direct_(direct) {}

} // namespace duet::orchestrator
