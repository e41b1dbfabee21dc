#include "solid_solver/mesh_file.hpp"

#include "solid_solver/msh_reader.hpp"

#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

namespace duet::solid {

namespace {

/// Starts a program found on the PATH with its words in `log`; its process number.
pid_t start(const std::vector<std::string>& words, const std::filesystem::path& log) {
    std::vector<char*> arguments;
    for (const std::string& word : words) {
        arguments.push_back(const_cast<char*>(word.c_str())); // posix_spawn does not write to them
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(
        &files, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
    posix_spawn_file_actions_adddup2(&files, 1, 2);
    pid_t process = 0;
    const int fault =
        posix_spawnp(&process, arguments[0], &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (fault != 0) {
        throw std::invalid_argument("A .geo file is meshed by the program gmsh, which cannot be "
                                    "started here ("
                                    + std::string(std::strerror(fault))
                                    + "); install it, or give a .msh file.");
    }
    return process;
}

/// Its exit status; -1 if it had to be stopped.
int wait_for(pid_t process) {
    using namespace std::chrono_literals;
    const auto last = std::chrono::steady_clock::now() + 10min;
    int status = 0;
    while (waitpid(process, &status, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > last) {
            kill(process, SIGKILL);
            waitpid(process, &status, 0);
            return -1;
        }
        std::this_thread::sleep_for(10ms);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// What gmsh found wrong, or else the end of what it said.
std::string complaint(const std::filesystem::path& log) {
    std::ifstream file(log);
    std::string line, errors, last;
    while (std::getline(file, line)) {
        last = line;
        if (line.rfind("Error", 0) == 0) {
            errors += (errors.empty() ? "" : "; ") + line;
        }
    }
    return errors.empty() ? last : errors;
}

std::filesystem::path mesh_geometry(const std::filesystem::path& path,
                                    double element_size,
                                    const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::filesystem::path mesh = folder / path.filename(), log = mesh;
    mesh.replace_extension(".msh");
    log.replace_extension(".gmsh.txt");
    std::vector<std::string> words = {
        "gmsh", "-2", "-order", "1", "-format", "msh41", "-nopopup", "-v", "2"};
    if (element_size > 0) {
        std::ostringstream size;
        size.precision(17);
        size << element_size;
        words.insert(words.end(), {"-clmax", size.str()});
    }
    words.insert(words.end(), {"-o", mesh.string(), path.string()});
    std::filesystem::remove(mesh);
    const int status = wait_for(start(words, log));
    if (status != 0 || !std::filesystem::exists(mesh)) {
        throw std::invalid_argument("gmsh could not mesh " + path.string() + ": " + complaint(log)
                                    + " (all it said is in " + log.string() + ")");
    }
    return mesh;
}

} // namespace

Mesh read_mesh_file(const std::filesystem::path& path,
                    const std::vector<std::string>& parts,
                    double element_size,
                    const std::filesystem::path& folder) {
    const std::filesystem::path mesh =
        path.extension() == ".geo" ? mesh_geometry(path, element_size, folder) : path;
    std::ifstream file(mesh);
    if (!file) {
        throw std::invalid_argument("The mesh " + mesh.string() + " cannot be opened.");
    }
    return read_msh(file, mesh.string(), parts);
}

} // namespace duet::solid
