// The books of both sides, compared window by window: what left one side arrived at the other.

#pragma once

#include "duet/v1/coupling.pb.h"

#include <cstdint>
#include <optional>
#include <string>

namespace duet::orchestrator {

/// What the audit found, as relative numbers (figures.hpp says of what).
struct Balances {
    double heat = 0;
    double impulse = 0;
    double work = 0;
    double work_difference = 0;
    double total_heat_drift = 0;
    double mass_drift = 0;
};

class Audit {
  public:
    Audit(v1::Coupling::Schedule schedule, double tolerance);

    /// The books at the start; of a side that does not take part, none.
    void start(const v1::Ledger* solid, const v1::Ledger* fluid);

    /// The books after one more window. Returns the sentence that ends the run, if they do not
    /// balance.
    std::optional<std::string> window(const v1::Ledger* solid, const v1::Ledger* fluid);

    Balances balances() const;

  private:
    std::optional<std::string> compare(const v1::Ledger& solid, const v1::Ledger& fluid);
    std::optional<std::string> compare_work(const v1::Ledger& solid, const v1::Ledger& fluid);
    void follow_heat(const v1::Ledger* solid, const v1::Ledger* fluid);
    void follow_mass(const v1::Ledger& start, const v1::Ledger& now);

    bool in_flight_;   // the solid books a window's load in the next window
    bool work_behind_; // the fluid knows the motion of a window only in the next one
    double tolerance_;
    std::optional<v1::Ledger> solid_start_;
    std::optional<v1::Ledger> solid_before_; // after the window before
    std::optional<v1::Ledger> fluid_start_;
    std::optional<v1::Ledger> fluid_before_; // after the window before
    double heat_residual_ = 0;               // J/m, largest
    double heat_scale_ = 0;                  // J/m
    Balances found_;
};

} // namespace duet::orchestrator
