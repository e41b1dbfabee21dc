#include "protocol/socket_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <stdexcept>

namespace duet::protocol {

namespace {

// sockaddr_un::sun_path holds 108 bytes, the last one zero; a name in the folder needs some.
constexpr std::size_t longest_folder = 107 - 20;

} // namespace

SocketFolder::SocketFolder() {
    std::string reason = "no folder of XDG_RUNTIME_DIR, TMPDIR and /tmp has a path short enough";
    const std::initializer_list<const char*> bases = {
        std::getenv("XDG_RUNTIME_DIR"), std::getenv("TMPDIR"), "/tmp"};
    for (const char* base : bases) {
        if (base == nullptr || *base == '\0')
            continue;
        std::string pattern = std::string(base) + "/duet-XXXXXX";
        if (pattern.size() > longest_folder)
            continue;
        if (mkdtemp(pattern.data()) != nullptr) { // mkdtemp makes it 0700
            path_ = pattern;
            return;
        }
        reason = std::string(base) + ": " + std::strerror(errno);
    }
    throw std::runtime_error("Cannot make a private folder for the sockets (" + reason
                             + "); set TMPDIR to a short path that can be written.");
}

SocketFolder::~SocketFolder() {
    std::error_code ignored; // what cannot be removed is left; it holds sockets only
    std::filesystem::remove_all(path_, ignored);
}

std::string SocketFolder::address(const std::string& name) const {
    return "ipc://" + (path_ / name).string();
}

} // namespace duet::protocol
