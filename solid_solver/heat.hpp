// Heat of one body: lumped capacity, conduction, loads (24)-(31), explicit steps, exact accounts.

#pragma once

#include "solid_solver/body_config.hpp"
#include "solid_solver/conduction.hpp"

#include <array>
#include <span>
#include <vector>

namespace duet::solid {

/// Heat that has come in since the start, by its way; J/m.
struct HeatAccount {
    double interface = 0;
    double walls = 0;         ///< fluxes, convection, and what keeps prescribed temperatures
    double sources = 0;       ///< body sources (28)
    double thermoelastic = 0; ///< by compression (31)
};

class Heat {
  public:
    /// State: the initial temperature, with the prescribed ones already in their places.
    Heat(const BodyConfig& body, const Domains& domains);

    /// Constant heat flows into the nodes, W/m, from now on: [N].
    void set_interface_heat(std::span<const double> nodal);

    /// Brings fluxes and surroundings to the middle of a step and prescribed temperatures to its
    /// end; s since the start. Without a condition that varies this does nothing.
    void set_time(double begin, double end);

    /// One explicit step. `thermoelastic`: W/m into each node by compression, or empty.
    void step(double dt, std::span<const double> thermoelastic = {});

    // What an implicit step is made of (implicit.hpp).

    /// W/m into each node at `temperature` [N]: loads, convection and conduction.
    void flow(std::span<const double> temperature, std::span<double> out) const;
    /// W/m into the body through the boundary `condition` of its config: flux and convection at
    /// present, and what kept the prescribed temperature in the last step.
    double power_through(std::size_t condition) const;
    /// Books `length` seconds of the loads and of convection at `temperature` [N].
    void book(double length, std::span<const double> temperature);
    /// Ends a step of `length`: puts `heat` [N] J/m, booked before, and `thermoelastic` [N] J/m
    /// into the nodes; prescribed temperatures take what they need.
    void take(double length, std::span<const double> heat, std::span<const double> thermoelastic);
    const Conduction& conduction() const { return conduction_; }
    /// Calls visit(node, W/(m K)) for each node that exchanges heat by convection.
    template <class Visit>
    void for_exchange(const Visit& visit) const {
        for (const Exchange& exchange : exchange_) {
            visit(exchange.node, exchange.coefficient);
        }
    }
    /// Calls visit(node, K) for each node of prescribed temperature.
    template <class Visit>
    void for_prescribed(const Visit& visit) const {
        for (const Fixed& fixed : fixed_) {
            visit(fixed.node, fixed.temperature);
        }
    }

    /// 2 / lambda_max of C^-1 (K + exchange); 0: no limit, nothing conducts.
    double stable_step() const { return stable_step_; }

    std::span<const double> temperature() const { return temperature_; }
    std::span<const double> capacity() const { return capacity_; } ///< J/(m K)
    const HeatAccount& account() const { return account_; }
    /// J/m, held relative to the start: sum of C (T - T_start).
    double stored() const;
    /// sum of C T over sum of C.
    double mean_temperature() const;

    /// Replaces the temperatures [N]; the accounts start anew from them.
    void set_temperature(std::span<const double> temperature);

    /// The state, for save and restore: calls visit(vector or double&) on each part of it.
    template <class Visit>
    void visit_state(const Visit& visit) {
        visit(temperature_);
        visit(start_);
        visit(account_.interface);
        visit(account_.walls);
        visit(account_.sources);
        visit(account_.thermoelastic);
        for (Fixed& fixed : fixed_) {
            visit(fixed.power);
        }
    }

  private:
    struct Fixed {
        std::uint32_t node;
        std::size_t condition;
        Field field;
        double temperature = 0;
        double power = 0; ///< W/m that kept it in the last step
    };
    struct Exchange { ///< convection, lumped on a node like its capacity
        std::uint32_t node;
        double coefficient; ///< W/(m K)
        double temperature; ///< K, of the surroundings
    };
    /// A flux, or the surroundings of a convection, on one boundary edge.
    struct OnEdge {
        std::uint32_t a, b;
        std::size_t condition;
        double half; ///< m, of its length; times the coefficient for convection
        Field field;
    };

    void apply_boundary(const BodyConfig& body);
    void set_boundary(double middle, double end);
    std::array<double, 2> on_nodes(const OnEdge& edge, double time) const;
    void collect_load();
    void hold(double length);
    double bound() const;

    int threads_;
    Conduction conduction_;
    std::vector<double> capacity_;
    std::vector<Point> place_;      ///< [N] m, reference
    std::vector<double> constant_;  ///< W/m: body source and boundary fluxes
    std::vector<double> source_;    ///< W/m: body source
    std::vector<double> interface_; ///< W/m
    std::vector<double> load_;      ///< their sum
    std::vector<Fixed> fixed_;
    std::vector<Exchange> exchange_;
    std::vector<OnEdge> flux_, surroundings_;
    std::vector<double> ambient_; ///< [N] W/m by the surroundings' temperatures; work space
    double middle_ = 0;           ///< s, the time of the fluxes and surroundings
    bool varies_ = false;         ///< some condition changes in time
    double source_power_ = 0;     ///< W/m
    double flux_power_ = 0;
    double interface_power_ = 0;
    double stable_step_ = 0;

    std::vector<double> temperature_;
    std::vector<double> start_;
    HeatAccount account_;

    std::vector<double> next_, factor_, rate_; ///< work space
    double factor_dt_ = 0;                     ///< the step that factor_ = dt/C holds
};

} // namespace duet::solid
