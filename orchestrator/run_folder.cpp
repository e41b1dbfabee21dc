#include "orchestrator/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>

namespace duet::orchestrator {

namespace {

void empty(const std::filesystem::path& path) {
    for (const auto& entry : std::filesystem::directory_iterator(path))
        std::filesystem::remove_all(entry.path());
}

} // namespace

RunFolder::RunFolder(const std::filesystem::path& path, bool overwrite)
    : path_(std::filesystem::absolute(path).lexically_normal()) {
    std::error_code error;
    std::filesystem::create_directories(path_, error);
    if (error)
        throw std::runtime_error("cannot make the run folder " + path_.string() + ": "
                                 + error.message());
    lock_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0)
        throw std::runtime_error("cannot open the run folder " + path_.string() + ": "
                                 + std::strerror(errno));
    // The system lets go of the lock when this process ends, however it ends.
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        ::close(lock_);
        throw std::runtime_error("the run folder " + path_.string()
                                 + " is in use by another run; choose another with --output");
    }
    try {
        const bool run = std::filesystem::exists(path_ / "case.toml");
        if (overwrite && run)
            empty(path_);
        if (!std::filesystem::is_empty(path_))
            throw std::runtime_error(
                "the folder " + path_.string()
                + (run ? " holds a run already; choose another with --output, or --overwrite it"
                       : " holds other files than a run's; choose another with --output"));
    } catch (...) {
        ::close(lock_);
        throw;
    }
}

RunFolder::~RunFolder() {
    ::close(lock_);
}

void RunFolder::write(const std::string& name, const std::string& text) const {
    const std::filesystem::path aside = file(name + ".new");
    std::ofstream stream(aside);
    stream << text << std::flush;
    if (!stream)
        throw std::runtime_error("cannot write " + aside.string() + "; is the disk full?");
    stream.close();
    std::filesystem::rename(aside, file(name));
}

std::filesystem::path default_run_folder(const std::string& case_name) {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    ::localtime_r(&now, &local);
    char stamp[32];
    std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local);
    const std::filesystem::path base = std::filesystem::path("runs") / (case_name + "-" + stamp);
    std::filesystem::path path = base;
    for (int i = 2; std::filesystem::exists(path); ++i)
        path = base.string() + "-" + std::to_string(i);
    return path;
}

} // namespace duet::orchestrator
