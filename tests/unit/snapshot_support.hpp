// What the snapshot tests share: a folder that goes away, and reading back through the C API.

#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace duet::snapshot::test {

class Folder : public testing::Test {
  protected:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "duet-XXXXXX").string();
        folder = mkdtemp(name.data());
    }
    ~Folder() override { std::filesystem::remove_all(folder); }

    std::filesystem::path folder;
};

struct Array {
    std::vector<hsize_t> shape;
    std::vector<double> values;
};

/// Reads a data set as float64; an empty shape if there is none.
inline Array read(const std::filesystem::path& path, const std::string& name) {
    Array out;
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t data = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
    if (data >= 0) {
        const hid_t space = H5Dget_space(data);
        out.shape.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
        H5Sget_simple_extent_dims(space, out.shape.data(), nullptr);
        out.values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
        H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.values.data());
        H5Sclose(space);
        H5Dclose(data);
    }
    H5Fclose(file);
    return out;
}

inline std::string text(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// What a command prints, and its exit status.
struct Printed {
    std::string text;
    int status = -1;
};
inline Printed run(const std::string& command) {
    Printed out;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    std::array<char, 256> part{};
    while (fgets(part.data(), static_cast<int>(part.size()), pipe))
        out.text += part.data();
    out.status = pclose(pipe);
    return out;
}

} // namespace duet::snapshot::test
