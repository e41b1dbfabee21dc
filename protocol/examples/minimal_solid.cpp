// The smallest solid that takes part in a run: the outline of the scene's first body, at the body's
// initial temperature, moving with its initial velocity whatever the fluid does to it.
//
// It shows all a solid has to do. Give it to a run in the place of a real one, or start here to
// write one.

#include "protocol/function.hpp"
#include "protocol/participant.hpp"

#include <algorithm>
#include <cmath>

using namespace duet::protocol;
namespace v1 = duet::v1;

namespace {

class MinimalSolid final : public SolidSolver {
  public:
    std::string name() const override { return "duet-minimal-solid 1.0"; }

    // The scene holds every default: nothing is ever absent that has one.
    void configure(const v1::Configure& configure,
                   v1::Ready& ready,
                   std::vector<Chain>& chains,
                   InterfaceMotion& start) override {
        scene_ = configure.scene();
        const v1::Body& body = scene_.solid().body(0);
        temperature_ = number_of(body.initial_temperature(), "initial_temperature");
        if (scene_.has_fluid())
            outline(body, chains, start);
        start_ = start;
        ready.set_stable_step(0); // 0: any window will do
        ready.set_unknowns(start.nodes());
        ready.add_model("prescribed motion and temperature of body " + body.name());
        sample(*ready.mutable_sample(), 0);
        *ready.mutable_ledger() = ledger_;
    }

    // One window under constant loads. Positions are where the nodes are at its end.
    void advance(const Window& window,
                 const InterfaceLoad& load,
                 InterfaceMotion& end,
                 v1::Report& report) override {
        book(window, load);
        time_ = window.time + window.length;
        end = start_;
        for (std::size_t i = 0; i < end.position.size(); ++i)
            end.position[i] += time_ * end.velocity[i];
        report.set_steps(1);
        *report.mutable_ledger() = ledger_;
        if (window.sample)
            sample(*report.mutable_sample(), window.time + window.length);
    }

    // The whole state, as bytes in any form: here how far the body moved, and what has been booked.
    std::string save() const override {
        v1::Report state;
        state.set_time(time_);
        *state.mutable_ledger() = ledger_;
        return state.SerializeAsString();
    }
    void restore(const std::string& bytes) override {
        v1::Report state;
        state.ParseFromString(bytes);
        time_ = state.time();
        ledger_ = state.ledger();
    }

    void finish() override {}

  private:
    // Counter-clockwise from the lower left corner, so that the fluid lies to the right.
    void outline(const v1::Body& body, std::vector<Chain>& chains, InterfaceMotion& start) {
        const double x = body.rectangle().corner().x(), y = body.rectangle().corner().y();
        const double width = body.rectangle().width(), height = body.rectangle().height();
        const double corners[][2] = {
            {x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}, {x, y}};
        Chain chain;
        chain.closed = true;
        for (int side = 0; side < 4; ++side) {
            const auto& a = corners[side];
            const auto& b = corners[side + 1];
            const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
            const int segments =
                std::max(1, static_cast<int>(std::lround(length / body.element_size())));
            for (int j = 0; j < segments; ++j) {
                chain.nodes.push_back(static_cast<std::uint32_t>(start.nodes()));
                for (int d = 0; d < 2; ++d)
                    start.position.push_back(a[d] + (b[d] - a[d]) * j / segments);
                start.velocity.push_back(body.initial_velocity().x().number());
                start.velocity.push_back(body.initial_velocity().y().number());
                start.temperature.push_back(temperature_);
            }
        }
        chains.push_back(chain);
    }

    // What came through the interface. The temperature is prescribed, so what arrives as heat
    // leaves as a (negative) source, and the heat held stays what it was.
    void book(const Window& window, const InterfaceLoad& load) {
        double heat = 0, exchanged_heat = 0, impulse[2] = {0, 0}, exchanged_impulse = 0, work = 0;
        for (const double flow : load.heat_flow) {
            heat += window.length * flow;
            exchanged_heat += window.length * std::abs(flow);
        }
        for (std::size_t i = 0; i < load.force.size(); ++i) {
            impulse[i % 2] += window.length * load.force[i];
            exchanged_impulse += window.length * std::abs(load.force[i]);
            work += window.length * load.force[i] * start_.velocity[i];
        }
        ledger_.set_heat_from_interface(ledger_.heat_from_interface() + heat);
        ledger_.set_heat_from_sources(-ledger_.heat_from_interface());
        ledger_.set_exchanged_heat(ledger_.exchanged_heat() + exchanged_heat);
        ledger_.set_impulse_x(ledger_.impulse_x() + impulse[0]);
        ledger_.set_impulse_y(ledger_.impulse_y() + impulse[1]);
        ledger_.set_exchanged_impulse(ledger_.exchanged_impulse() + exchanged_impulse);
        ledger_.set_work(ledger_.work() + work);
    }

    // The probes that the scene asks of the solid.
    template <typename Samples>
    void sample(Samples& samples, double time) const {
        for (const v1::Probe& probe : scene_.probe()) {
            if (probe.of() != v1::Probe::SOLID)
                continue;
            v1::Sample& sample = *samples.Add();
            sample.set_probe(probe.name());
            sample.set_time(time);
            if (probe.quantity() == "temperature" || probe.quantity() == "mean_temperature")
                sample.add_value(temperature_);
            else if (probe.quantity() == "heat_received")
                sample.add_value(ledger_.heat_from_interface());
            else
                throw Error(v1::Failed::SCENE,
                            "Probe '" + probe.name() + "' asks for '" + probe.quantity()
                                + "'; this solid knows temperature, mean_temperature and "
                                  "heat_received.");
        }
    }

    v1::Scene scene_;
    InterfaceMotion start_;
    double time_ = 0;        // s
    double temperature_ = 0; // K
    v1::Ledger ledger_;
};

} // namespace

int main(int argc, char** argv) {
    MinimalSolid solid;
    return participate(solid, parse_arguments(argc, argv));
}
