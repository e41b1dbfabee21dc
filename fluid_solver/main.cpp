// duet-fluid: the fluid of a run. Started by `duet run`, or by hand with the address that it
// prints.

#include "fluid_solver/fluid_participant.hpp"
#include "protocol/participant.hpp"

int main(int argc, char** argv) {
    duet::fluid::Participant fluid;
    return duet::protocol::participate(fluid, duet::protocol::parse_arguments(argc, argv));
}
