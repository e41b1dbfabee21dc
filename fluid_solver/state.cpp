// Saving and restoring the whole state: what differs between two fluids built from one scene.

#include "fluid_solver/implementation.hpp"

#include <cstring>
#include <type_traits>

namespace duet::fluid {

namespace {

constexpr std::uint64_t state_mark = 0x3644554c46544455; // layout of the bytes below

class Writer {
  public:
    template <class T>
    void operator()(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        (*this)(values.size());
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    std::string bytes;
};

class Reader {
  public:
    explicit Reader(const std::string& source) : bytes(source) {}
    template <class T>
    void operator()(T& value) {
        take(&value, sizeof value);
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        std::size_t size = 0;
        (*this)(size);
        if (size != values.size()) {
            throw SceneError("the saved fluid state is of another scene: it holds "
                             + std::to_string(size) + " entries where this one has "
                             + std::to_string(values.size())
                             + "; restore it into the scene that it was saved from");
        }
        take(values.data(), size * sizeof(T));
    }
    void end() const {
        if (at != bytes.size()) {
            throw SceneError("the saved fluid state is longer than it should be; use the file that "
                             "this run wrote");
        }
    }

  private:
    void take(void* to, std::size_t size) {
        if (size > bytes.size() - at) {
            throw SceneError("the saved fluid state ends early after "
                             + std::to_string(bytes.size())
                             + " bytes; use the file that this run wrote");
        }
        if (size > 0) { // an empty vector has no address
            std::memcpy(to, bytes.data() + at, size);
        }
        at += size;
    }
    const std::string& bytes;
    std::size_t at = 0;
};

} // namespace

/// Every member that a step changes and the next one reads. The order of the particles is part of
/// it: sums follow that order.
template <class Archive, class Self>
void Fluid::Implementation::transfer(Archive& archive, Self& self) {
    archive(self.time);
    archive(self.particles.x);
    archive(self.particles.y);
    archive(self.particles.fields);
    archive(self.particles.relaxing);
    archive(self.particles.rate);
    archive(self.particles.laplacian);
    archive(self.particles.identity);
    archive(self.particles.compartment);
    archive(self.particles.cell_start_);
    archive(self.interface_position_);
    archive(self.interface_velocity_);
    archive(self.interface_acceleration_);
    archive(self.interface_temperature_);
    archive(self.hydrostatics_.levels);
    archive(self.passed.impulse);
    archive(self.passed.heat);
    archive(self.speed_);
    archive(self.pressure_range_);
    archive(self.sound_speed_);
    archive(self.initial_heat_);
    archive(self.initial_kinetic_energy_);
    archive(self.initial_momentum_);
    archive(self.heat_);
    archive(self.still_);
    archive(self.totals_);
    archive(self.mark_);
    for (auto& wall : self.walls) {
        archive(wall.heat_flow);
        archive(wall.heat);
        archive(wall.force);
        archive(wall.torque);
    }
}

std::string Fluid::Implementation::save() const {
    Writer writer;
    writer(state_mark);
    transfer(writer, *this);
    return std::move(writer.bytes);
}

void Fluid::Implementation::restore(const std::string& state) {
    Reader reader(state);
    std::uint64_t mark = 0;
    reader(mark);
    if (mark != state_mark) {
        throw SceneError("these bytes are no saved fluid state of this version; use the file that "
                         "this run wrote");
    }
    transfer(reader, *this);
    reader.end();
    boundary_.set_walls(time);
    put_interface();
    evaluated_ = false;
}

} // namespace duet::fluid
