#include "process/duet_run.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace duet::test {

Folder::Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "duet-test-XXXXXX").string();
    if (!::mkdtemp(name.data()))
        throw std::runtime_error("cannot make " + name);
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string read(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

void pause_briefly() {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

DuetRun::DuetRun(const Folder& folder, const std::vector<std::string>& arguments) {
    static int number = 0;
    const std::string tag = std::to_string(::getpid()) + "-" + std::to_string(++number);
    mark_ = "DUET_TEST_MARK=" + tag;
    output_ = folder / ("output-" + tag);
    stamp_ = folder / ("stamp-" + tag);
    std::vector<std::string> words = {DUET_BINARY_DIR "/bin/duet"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);

    id_ = ::fork();
    if (id_ != 0)
        return;
    const int file = ::open(output_.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::setenv("DUET_TEST_MARK", tag.c_str(), 1);
    ::setenv("DUET_TEST_STAMP", stamp_.c_str(), 1);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
}

DuetRun::~DuetRun() {
    for (const pid_t process : left_running())
        ::kill(process, SIGKILL);
    if (!status_)
        ::waitpid(id_, nullptr, 0);
}

std::optional<int> DuetRun::wait(double seconds) {
    eventually(seconds, [&] {
        int status = 0;
        if (!status_ && ::waitpid(id_, &status, WNOHANG) == id_) {
            ended_at_ = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
            status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        }
        return status_.has_value();
    });
    return status_;
}

void DuetRun::signal(int number) const {
    ::kill(id_, number);
}

std::vector<pid_t> DuetRun::left_running() const {
    std::vector<pid_t> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") == std::string::npos
            && read(entry.path() / "environ").find(mark_) != std::string::npos)
            found.push_back(std::stoi(name));
    }
    return found;
}

} // namespace duet::test
