#include "orchestrator/recorder.hpp"

#include "orchestrator/schema.hpp"
#include "snapshot/hdf5.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <stdexcept>

namespace duet::orchestrator {

bool is_profile(const v1::Probe& probe) {
    return probe.line_size() > 0 && probe.reduce() == v1::Probe::EACH;
}

/// coupling.h5: groups motion_start, motion_00000000, load_00000000, ... with the arrays of the
/// message and its time; the chains of the interface in motion_start.
struct Recorder::CouplingFile {
    explicit CouplingFile(const std::filesystem::path& path) : file(path) {}

    snapshot::hdf5::Group create(const std::string& kind, std::uint64_t window) {
        std::string number = std::to_string(window);
        number.insert(0, number.size() < 8 ? 8 - number.size() : 0, '0');
        return file.create(kind + "_" + number);
    }

    snapshot::hdf5::File file;
    std::chrono::steady_clock::time_point flushed = std::chrono::steady_clock::now();
};

namespace {

void write_array(snapshot::hdf5::Group& group,
                 const std::string& name,
                 const std::string& bytes,
                 hsize_t components) {
    std::vector<double> values(bytes.size() / sizeof(double));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
    std::vector<hsize_t> shape = {values.size() / components};
    if (components > 1)
        shape.push_back(components);
    group.write<double>(name, values, shape);
}

std::ofstream create(const std::filesystem::path& path) {
    std::ofstream stream(path);
    if (!stream)
        throw std::runtime_error("cannot write " + path.string());
    return stream;
}

} // namespace

Recorder::Recorder(const v1::Scene& scene, const RunFolder& folder) : scene_(scene) {
    probes_ = create(folder.file("probes.csv"));
    probes_ << "time";
    bool profiles = false;
    for (const v1::Probe& probe : scene.probe()) {
        if (is_profile(probe))
            profiles = true;
        else
            probes_ << ',' << probe.name();
    }
    probes_ << '\n' << std::flush;
    if (profiles) {
        profile_lines_ = create(folder.file("profiles.csv"));
        profile_lines_ << "time,probe,position,value\n" << std::flush;
    }
    if (scene.output().coupling() && scene.has_fluid() && scene.has_solid())
        coupling_ = std::make_unique<CouplingFile>(folder.file("coupling.h5"));
}

Recorder::~Recorder() = default;

void Recorder::record(double time, const std::vector<v1::Sample>& samples) {
    probes_ << number_text(time);
    for (const v1::Probe& probe : scene_.probe()) {
        const auto found = std::find_if(samples.begin(), samples.end(), [&](const v1::Sample& s) {
            return s.probe() == probe.name();
        });
        if (!is_profile(probe))
            probes_ << ',';
        if (found == samples.end())
            continue;
        if (is_profile(probe)) {
            record_profile(time, *found);
            continue;
        }
        if (found->value_size() != 1)
            throw std::runtime_error("the probe '" + probe.name()
                                     + "' has one value, its solver sent "
                                     + std::to_string(found->value_size()));
        probes_ << number_text(found->value(0));
        histories_[probe.name()].time.push_back(time);
        histories_[probe.name()].value.push_back(found->value(0));
    }
    probes_ << '\n' << std::flush;
    profile_lines_.flush();
    if (!probes_)
        throw std::runtime_error("cannot write probes.csv; is the disk full?");
}

void Recorder::record_profile(double time, const v1::Sample& sample) {
    if (sample.value_size() != sample.position_size())
        throw std::runtime_error("the line probe '" + sample.probe()
                                 + "' has as many values as "
                                   "positions, its solver sent "
                                 + std::to_string(sample.value_size()) + " and "
                                 + std::to_string(sample.position_size()));
    for (int i = 0; i < sample.value_size(); ++i)
        profile_lines_ << number_text(time) << ',' << sample.probe() << ','
                       << number_text(sample.position(i)) << ',' << number_text(sample.value(i))
                       << '\n';
    profiles_[sample.probe()].push_back({time,
                                         {sample.position().begin(), sample.position().end()},
                                         {sample.value().begin(), sample.value().end()}});
}

void Recorder::record(const v1::ToPeer& exchange) {
    if (!coupling_)
        return;
    if (exchange.has_motion()) {
        const v1::InterfaceMotion& motion = exchange.motion();
        auto group = motion.start() ? coupling_->file.create("motion_start")
                                    : coupling_->create("motion", motion.window());
        group.attribute("time", motion.time());
        write_array(group, "position", motion.position(), 2);
        write_array(group, "velocity", motion.velocity(), 2);
        write_array(group, "temperature", motion.temperature(), 1);
        for (int i = 0; i < motion.chain_size(); ++i) {
            const auto& chain = motion.chain(i);
            auto place = group.create("chain_" + std::to_string(i));
            place.attribute("closed", chain.closed() ? 1.0 : 0.0);
            const std::vector<std::uint32_t> nodes(chain.node().begin(), chain.node().end());
            place.write<std::uint32_t>("node", nodes, {nodes.size()});
        }
    } else if (exchange.has_load()) {
        const v1::InterfaceLoad& load = exchange.load();
        auto group = coupling_->create("load", load.window());
        group.attribute("time", load.time());
        group.attribute("length", load.length());
        group.attribute("impulse_x", load.impulse_x());
        group.attribute("impulse_y", load.impulse_y());
        group.attribute("heat", load.heat());
        group.attribute("impedance", load.impedance());
        write_array(group, "force", load.force(), 2);
        write_array(group, "heat_flow", load.heat_flow(), 1);
    }
    if (std::chrono::steady_clock::now() - coupling_->flushed > std::chrono::seconds(1)) {
        coupling_->file.flush();
        coupling_->flushed = std::chrono::steady_clock::now();
    }
}

} // namespace duet::orchestrator
