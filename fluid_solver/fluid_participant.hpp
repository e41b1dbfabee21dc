// The fluid core as a participant of a run: scene in, interface loads, probes and snapshots out.

#pragma once

#include "fluid_solver/fluid.hpp"
#include "protocol/solver.hpp"
#include "snapshot/series.hpp"

#include <functional>
#include <map>
#include <optional>

namespace duet::fluid {

/// The scene's fluid, its walls and gravity as the core takes them.
Config config_from_scene(const v1::Scene& scene, unsigned threads);

class Participant : public protocol::FluidSolver {
  public:
    std::string name() const override;
    void configure(const v1::Configure& configure,
                   const std::vector<protocol::Chain>& chains,
                   const protocol::InterfaceMotion& start,
                   v1::Ready& ready) override;
    void advance(const protocol::Window& window,
                 const protocol::InterfaceMotion& start,
                 const protocol::InterfaceMotion& end,
                 protocol::InterfaceLoad& load,
                 v1::Report& report) override;
    std::string save() const override;
    void restore(const std::string& state) override;
    void finish() override;

  private:
    double longest_window(const v1::Ledger& now) const;
    void fill(v1::Ledger& ledger) const;
    void take_probes(google::protobuf::RepeatedPtrField<v1::Sample>& samples) const;
    void write_snapshot();

    v1::Scene scene_;
    std::optional<Fluid> fluid_;
    std::optional<snapshot::Series> series_;
    InterfaceState start_, end_;
};

} // namespace duet::fluid
