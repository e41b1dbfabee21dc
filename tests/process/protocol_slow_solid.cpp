// A solid for the tests whose windows take a minute.

#include "protocol/participant.hpp"

#include <chrono>
#include <thread>

using namespace duet::protocol;
namespace v1 = duet::v1;

namespace {

class SlowSolid final : public SolidSolver {
  public:
    std::string name() const override { return "slow solid"; }
    void
    configure(const v1::Configure&, v1::Ready&, std::vector<Chain>&, InterfaceMotion&) override {}
    void
    advance(const Window&, const InterfaceLoad&, InterfaceMotion&, v1::Report& report) override {
        std::this_thread::sleep_for(std::chrono::minutes(1));
        report.set_steps(1);
    }
    std::string save() const override { return ""; }
    void restore(const std::string&) override {}
    void finish() override {}
};

} // namespace

int main(int argc, char** argv) {
    SlowSolid solid;
    return participate(solid, parse_arguments(argc, argv));
}
