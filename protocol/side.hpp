// One side of a window: a solver, what it last received, and what it gives. The participant drives
// it by the schedule without knowing which side it is.

#pragma once

#include "protocol/exchange.hpp"
#include "protocol/schedule.hpp"

namespace duet::protocol {

class Side {
  public:
    virtual ~Side() = default;

    virtual v1::Role role() const = 0;
    virtual Solver& solver() = 0;

    /// Builds the solver's model and exchanges the start of the interface; `exchange` is null if
    /// there is no other solver.
    virtual void
    configure(const v1::Configure& configure, Exchange* exchange, v1::Ready& ready) = 0;

    virtual void receive(const Window& window, Exchange& exchange) = 0;
    virtual void advance(const Window& window, v1::Report& report) = 0;
    virtual void send(const Window& window, Exchange& exchange) = 0;

    /// What was received last, into a checkpoint and back.
    virtual void store(v1::Checkpoint& checkpoint) const = 0;
    virtual void restore(const v1::Checkpoint& checkpoint) = 0;
};

class SolidSide final : public Side {
  public:
    explicit SolidSide(SolidSolver& solid) : solid_(solid) {}
    v1::Role role() const override { return v1::ROLE_SOLID; }
    Solver& solver() override { return solid_; }
    void configure(const v1::Configure& configure, Exchange* exchange, v1::Ready& ready) override;
    void receive(const Window& window, Exchange& exchange) override;
    void advance(const Window& window, v1::Report& report) override;
    void send(const Window& window, Exchange& exchange) override;
    void store(v1::Checkpoint& checkpoint) const override;
    void restore(const v1::Checkpoint& checkpoint) override;

  private:
    const InterfaceLoad& over(const Window& window);

    SolidSolver& solid_;
    InterfaceSize size_;
    InterfaceMotion motion_;
    InterfaceLoad load_;   // the last one; zero before the first
    InterfaceLoad spread_; // the same impulse and heat over a window of another length
};

class FluidSide final : public Side {
  public:
    explicit FluidSide(FluidSolver& fluid) : fluid_(fluid) {}
    v1::Role role() const override { return v1::ROLE_FLUID; }
    Solver& solver() override { return fluid_; }
    void configure(const v1::Configure& configure, Exchange* exchange, v1::Ready& ready) override;
    void receive(const Window& window, Exchange& exchange) override;
    void advance(const Window& window, v1::Report& report) override;
    void send(const Window& window, Exchange& exchange) override;
    void store(v1::Checkpoint& checkpoint) const override;
    void restore(const v1::Checkpoint& checkpoint) override;

  private:
    void book_work(const Window& window);

    FluidSolver& fluid_;
    InterfaceSize size_;
    bool end_is_known_ = false;
    InterfaceMotion previous_;
    InterfaceMotion latest_;
    InterfaceMotion guess_;
    bool solid_lags_ = false;   // it advances with the load of the window before
    InterfaceLoad load_;        // the last one; zero before the first
    InterfaceLoad load_before_; // where the solid lags: the one before that
    double work_of_loads_ = 0, exchanged_work_ = 0; // J/m
};

} // namespace duet::protocol
