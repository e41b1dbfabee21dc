// Where the sockets of one run live.

#pragma once

#include <filesystem>
#include <string>

namespace duet::protocol {

/// A new folder that only this user may enter (0700), under XDG_RUNTIME_DIR, TMPDIR or /tmp, the
/// first that exists and keeps a Unix socket's path below its limit of 107 characters. Removed with
/// all it holds at the end.
class SocketFolder {
  public:
    /// Throws std::runtime_error naming the folder and the reason.
    SocketFolder();
    ~SocketFolder();
    SocketFolder(const SocketFolder&) = delete;
    SocketFolder& operator=(const SocketFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// "ipc://<folder>/<name>"
    std::string address(const std::string& name) const;

  private:
    std::filesystem::path path_;
};

} // namespace duet::protocol
