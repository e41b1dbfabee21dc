#include "orchestrator/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

extern char** environ;

namespace duet::orchestrator {

namespace {

struct Pipe {
    Pipe() {
        if (::pipe2(end.data(), O_CLOEXEC) != 0)
            throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    }
    ~Pipe() {
        for (const int descriptor : end)
            if (descriptor >= 0)
                ::close(descriptor);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    int release(std::size_t i) { return std::exchange(end[i], -1); }
    std::array<int, 2> end{-1, -1}; // read, write
};

std::vector<char*> pointers(const std::vector<std::string>& texts) {
    std::vector<char*> out;
    for (const std::string& text : texts)
        out.push_back(const_cast<char*>(text.c_str()));
    out.push_back(nullptr);
    return out;
}

std::vector<std::string> merged(const std::map<std::string, std::string>& added) {
    std::vector<std::string> out;
    for (char** at = environ; *at; ++at) {
        const std::string entry = *at;
        if (!added.contains(entry.substr(0, entry.find('='))))
            out.push_back(entry);
    }
    for (const auto& [name, value] : added)
        out.push_back(name + "=" + value);
    return out;
}

/// Between fork and exec: system calls alone. On failure errno goes up the pipe.
[[noreturn]] void become(char** command, char** environment, int output, int failed, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) // the parent died before the line above
        ::_exit(127);
    ::setpgid(0, 0);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execve(command[0], command, environment);
    const int reason = errno;
    [[maybe_unused]] const auto written = ::write(failed, &reason, sizeof reason);
    ::_exit(127);
}

} // namespace

Process::Process(const std::vector<std::string>& command,
                 const std::map<std::string, std::string>& environment,
                 std::function<void(const std::string&)> say)
    : say_(std::move(say)) {
    Pipe output;
    Pipe failed;
    const std::vector<std::string> variables = merged(environment);
    std::vector<char*> arguments = pointers(command);
    std::vector<char*> surroundings = pointers(variables);
    const pid_t parent = ::getpid();
    id_ = ::fork();
    if (id_ == 0)
        become(arguments.data(), surroundings.data(), output.end[1], failed.end[1], parent);
    if (id_ < 0)
        throw std::runtime_error("cannot start " + command[0] + ": " + std::strerror(errno));

    ::close(failed.release(1));
    int reason = 0;
    if (::read(failed.end[0], &reason, sizeof reason) == sizeof reason) {
        ::waitpid(id_, nullptr, 0);
        throw std::runtime_error("cannot start " + command[0] + ": " + std::strerror(reason));
    }
    pidfd_ = static_cast<int>(::syscall(SYS_pidfd_open, id_, 0));
    if (pidfd_ < 0) {
        const std::string why = std::strerror(errno);
        kill();
        ::waitpid(id_, nullptr, 0);
        throw std::runtime_error("cannot watch the process of " + command[0] + ": " + why);
    }
    output_ = output.release(0);
    ::fcntl(output_, F_SETFL, O_NONBLOCK);
}

Process::~Process() {
    kill();
    wait_until(Clock::now() + std::chrono::seconds(5));
    for (const int descriptor : {pidfd_, output_})
        if (descriptor >= 0)
            ::close(descriptor);
}

void Process::read_output() {
    std::array<char, 4096> buffer{};
    while (output_ >= 0) {
        const auto count = ::read(output_, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            return; // nothing now
        if (count == 0) {
            ::close(std::exchange(output_, -1));
            if (!line_.empty())
                say_(std::exchange(line_, {}));
            return;
        }
        line_.append(buffer.data(), static_cast<std::size_t>(count));
        for (std::size_t end; (end = line_.find('\n')) != std::string::npos;) {
            say_(line_.substr(0, end));
            line_.erase(0, end + 1);
        }
        if (line_.size() > 65536) // no line, but a flood
            say_(std::exchange(line_, {}));
    }
}

const std::optional<Ending>& Process::poll() {
    if (ending_)
        return ending_;
    int status = 0;
    rusage used{};
    if (::wait4(id_, &status, WNOHANG, &used) != id_)
        return ending_;
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    Ending ending;
    ending.good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    ending.text = WIFSIGNALED(status) ? "was ended by signal " + std::to_string(WTERMSIG(status))
                                            + " (" + ::strsignal(WTERMSIG(status)) + ")"
                                      : "exited with status " + std::to_string(WEXITSTATUS(status));
    ending.cpu = seconds(used.ru_utime) + seconds(used.ru_stime);
    ending.peak_memory = static_cast<std::uint64_t>(used.ru_maxrss) * 1024;
    ending_ = ending;
    ::kill(-id_, SIGKILL); // whatever it has started goes with it
    read_output();
    return ending_;
}

const std::optional<Ending>& Process::wait_until(Clock::time_point deadline) {
    while (!poll()) {
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0)
            break;
        // Emptied meanwhile, lest the process block on a full pipe.
        std::array<pollfd, 2> watched{{{pidfd_, POLLIN, 0}, {output_, POLLIN, 0}}};
        ::poll(watched.data(), watched.size(), static_cast<int>(left));
        read_output();
    }
    return ending_;
}

void Process::kill() {
    if (!ending_ && id_ > 0) {
        ::kill(-id_, SIGKILL);
        ::kill(id_, SIGKILL); // its group may not be there yet
    }
}

std::string Process::state() const {
    std::ifstream stat("/proc/" + std::to_string(id_) + "/stat");
    std::ostringstream text;
    text << stat.rdbuf();
    const std::string all = text.str();
    const std::size_t name_end = all.rfind(')'); // the name may hold blanks and brackets
    if (name_end == std::string::npos || name_end + 2 >= all.size())
        return "gone";
    switch (all[name_end + 2]) {
    case 'T':
    case 't':
        return "stopped";
    case 'Z':
    case 'X':
        return "ended";
    default:
        return "alive";
    }
}

std::filesystem::path program_folder() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

namespace {

bool executable(const std::filesystem::path& file) {
    return std::filesystem::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0;
}

std::vector<std::filesystem::path> search_path() {
    std::vector<std::filesystem::path> folders = {program_folder()};
    const char* variable = std::getenv("PATH");
    std::istringstream all(variable ? variable : "");
    for (std::string folder; std::getline(all, folder, ':');)
        folders.emplace_back(folder.empty() ? "." : folder);
    return folders;
}

} // namespace

std::vector<std::string> find_command(const std::string& given, const std::string& option) {
    std::vector<std::string> command;
    if (executable(given)) {
        command = {given};
    } else {
        std::istringstream words(given);
        for (std::string word; words >> word;)
            command.push_back(word);
    }
    if (command.empty())
        throw std::runtime_error("no program is given with " + option);
    const std::string program = command[0];
    if (program.find('/') != std::string::npos) {
        if (!executable(program))
            throw std::runtime_error("there is no program " + program + "; give another with "
                                     + option);
        command[0] = std::filesystem::absolute(program).string();
        return command;
    }
    for (const std::filesystem::path& folder : search_path())
        if (executable(folder / program)) {
            command[0] = std::filesystem::absolute(folder / program).string();
            return command;
        }
    throw std::runtime_error("there is no program '" + program
                             + "' beside duet or in PATH; build "
                               "it, or give another with "
                             + option);
}

} // namespace duet::orchestrator
