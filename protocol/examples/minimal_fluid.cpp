// The smallest fluid that takes part in a run: it loads the interface with a constant traction and
// a constant heat flux, whatever the solid does.
//
// It shows all a fluid has to do. Give it to a run in the place of a real one, or start here to
// write one.

#include "protocol/function.hpp"
#include "protocol/participant.hpp"

#include <cmath>

using namespace duet::protocol;
namespace v1 = duet::v1;

namespace {

constexpr double heat_flux = 100;           // W/m2, into the solid
constexpr double traction[2] = {0.3, -0.2}; // Pa, on the solid

class MinimalFluid final : public FluidSolver {
  public:
    std::string name() const override { return "duet-minimal-fluid 1.0"; }

    // The interface comes first: its chains of nodes, and where they are at the start.
    void configure(const v1::Configure& configure,
                   const std::vector<Chain>& chains,
                   const InterfaceMotion&,
                   v1::Ready& ready) override {
        scene_ = configure.scene();
        temperature_ = number_of(scene_.fluid().initial_temperature(), "initial_temperature");
        chains_ = chains;
        ready.set_stable_step(0); // 0: any window will do
        ready.add_model("prescribed traction and heat flux on the interface");
        sample(*ready.mutable_sample(), 0);
        *ready.mutable_ledger() = ledger_;
    }

    // One window, while the interface moves from `start` to `end`. The answer: a force on each node
    // and a heat flow into each segment, means over the window.
    void advance(const Window& window,
                 const InterfaceMotion& start,
                 const InterfaceMotion& end,
                 InterfaceLoad& load,
                 v1::Report& report) override {
        load.force.assign(2 * end.nodes(), 0);
        load.heat_flow.clear();
        for (const Chain& chain : chains_)
            load_chain(chain, end, load);
        book(window, start, load);
        report.set_steps(1);
        *report.mutable_ledger() = ledger_;
        if (window.sample)
            sample(*report.mutable_sample(), window.time + window.length);
    }

    // The whole state: here only what has been booked (the library keeps the interface).
    std::string save() const override { return ledger_.SerializeAsString(); }
    void restore(const std::string& state) override { ledger_.ParseFromString(state); }

    void finish() override {}

  private:
    // Segment j runs from node j of the chain to the next; half of its force goes to each end.
    static void load_chain(const Chain& chain, const InterfaceMotion& motion, InterfaceLoad& load) {
        for (std::size_t j = 0; j < chain.segments(); ++j) {
            const std::size_t m = chain.nodes[j];
            const std::size_t n = chain.nodes[(j + 1) % chain.nodes.size()];
            const double length =
                std::hypot(motion.position[2 * n] - motion.position[2 * m],
                           motion.position[2 * n + 1] - motion.position[2 * m + 1]);
            load.heat_flow.push_back(heat_flux * length);
            for (std::size_t d = 0; d < 2; ++d) {
                load.force[2 * m + d] += traction[d] * length / 2;
                load.force[2 * n + d] += traction[d] * length / 2;
            }
        }
    }

    // What is sent, booked with the sign of what the fluid receives; the totals go with the load so
    // that the other side can compare. The heat that leaves is drawn from a source, and the heat
    // held stays what it was.
    void book(const Window& window, const InterfaceMotion& motion, InterfaceLoad& load) {
        double impulse[2] = {0, 0}, exchanged_impulse = 0, work = 0, exchanged_heat = 0;
        load.heat = 0;
        for (const double flow : load.heat_flow) {
            load.heat += window.length * flow;
            exchanged_heat += window.length * std::abs(flow);
        }
        for (std::size_t i = 0; i < load.force.size(); ++i) {
            impulse[i % 2] += window.length * load.force[i];
            exchanged_impulse += window.length * std::abs(load.force[i]);
            work += window.length * load.force[i] * motion.velocity[i];
        }
        load.impulse_x = impulse[0];
        load.impulse_y = impulse[1];
        ledger_.set_heat_from_interface(ledger_.heat_from_interface() - load.heat);
        ledger_.set_heat_from_sources(-ledger_.heat_from_interface());
        ledger_.set_exchanged_heat(ledger_.exchanged_heat() + exchanged_heat);
        ledger_.set_impulse_x(ledger_.impulse_x() - impulse[0]);
        ledger_.set_impulse_y(ledger_.impulse_y() - impulse[1]);
        ledger_.set_exchanged_impulse(ledger_.exchanged_impulse() + exchanged_impulse);
        ledger_.set_work(ledger_.work() - work);
    }

    // The probes that the scene asks of the fluid.
    template <typename Samples>
    void sample(Samples& samples, double time) const {
        for (const v1::Probe& probe : scene_.probe()) {
            if (probe.of() != v1::Probe::FLUID)
                continue;
            v1::Sample& sample = *samples.Add();
            sample.set_probe(probe.name());
            sample.set_time(time);
            if (probe.quantity() == "temperature" || probe.quantity() == "mean_temperature")
                sample.add_value(temperature_);
            else
                throw Error(v1::Failed::SCENE,
                            "Probe '" + probe.name() + "' asks for '" + probe.quantity()
                                + "'; this fluid knows temperature and mean_temperature.");
        }
    }

    v1::Scene scene_;
    std::vector<Chain> chains_;
    double temperature_ = 0; // K
    v1::Ledger ledger_;
};

} // namespace

int main(int argc, char** argv) {
    MinimalFluid fluid;
    return participate(fluid, parse_arguments(argc, argv));
}
