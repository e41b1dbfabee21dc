// The solid core as a participant of a run: scene in, interface motion, probes and snapshots out.

#pragma once

#include "protocol/solver.hpp"
#include "snapshot/series.hpp"
#include "solid_solver/solid.hpp"
#include "solid_solver/solid_probes.hpp"

#include <memory>
#include <optional>

namespace duet::solid {

class Participant : public protocol::SolidSolver {
  public:
    std::string name() const override;
    void configure(const v1::Configure& configure,
                   v1::Ready& ready,
                   std::vector<protocol::Chain>& chains,
                   protocol::InterfaceMotion& start) override;
    void advance(const protocol::Window& window,
                 const protocol::InterfaceLoad& load,
                 protocol::InterfaceMotion& end,
                 v1::Report& report) override;
    std::string save() const override;
    void restore(const std::string& state) override;
    void finish() override;

  private:
    double longest_window() const;
    void fill(v1::Ledger& ledger) const;
    void fill(protocol::InterfaceMotion& motion) const;
    void describe(v1::Ready& ready) const;
    void write_snapshot();

    v1::Scene scene_;
    std::unique_ptr<Solid> solid_;
    Probes probes_;
    std::optional<snapshot::Series> series_;
    double time_ = 0;
    double impedance_ = 0; ///< Pa s/m, of the fluid, as the last load told it
};

} // namespace duet::solid
