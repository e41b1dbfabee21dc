// duet-solid: the solid of a run. Started by `duet run`, or by hand with the address that it
// prints.

#include "protocol/participant.hpp"
#include "solid_solver/solid_participant.hpp"

int main(int argc, char** argv) {
    duet::solid::Participant solid;
    return duet::protocol::participate(solid, duet::protocol::parse_arguments(argc, argv));
}
