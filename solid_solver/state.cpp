#include "solid_solver/state.hpp"

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace duet::solid {

namespace {

struct Writer {
    std::string& bytes;

    void operator()(double& value) const { put(&value, 1); }
    void operator()(std::vector<double>& values) const {
        const std::uint64_t count = values.size();
        bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
        put(values.data(), values.size());
    }
    void put(const double* values, std::size_t count) const {
        bytes.append(reinterpret_cast<const char*>(values), count * sizeof(double));
    }
};

struct Reader {
    const std::string& bytes;
    std::size_t& position;

    void operator()(double& value) const { take(&value, sizeof value); }
    void operator()(std::vector<double>& values) const {
        std::uint64_t count = 0;
        take(&count, sizeof count);
        if (count != values.size()) {
            throw std::invalid_argument(
                "The saved state of the solid is of another scene: it holds "
                + std::to_string(count) + " numbers where " + std::to_string(values.size())
                + " are needed.");
        }
        take(values.data(), values.size() * sizeof(double));
    }
    void take(void* values, std::size_t size) const {
        if (size > bytes.size() - position) {
            throw std::invalid_argument("The saved state of the solid ends too early, after "
                                        + std::to_string(bytes.size())
                                        + " bytes; take an older one.");
        }
        std::memcpy(values, bytes.data() + position, size);
        position += size;
    }
};

} // namespace

std::string save_state(Solid& solid) {
    std::string bytes;
    solid.visit_state(Writer{bytes});
    return bytes;
}

void restore_state(Solid& solid, const std::string& state) {
    std::size_t position = 0;
    solid.visit_state(Reader{state, position});
    if (position != state.size()) {
        throw std::invalid_argument("The saved state of the solid is of another scene: it holds "
                                    + std::to_string(state.size() - position)
                                    + " bytes more than needed.");
    }
}

} // namespace duet::solid
