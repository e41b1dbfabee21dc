// The solver's side of the protocol: connect, handshake, serve leases, exchange with the peer,
// heartbeats.
//
//     int main(int argc, char** argv) {
//         MySolid solid;
//         return duet::protocol::participate(solid, duet::protocol::parse_arguments(argc, argv));
//     }

#pragma once

#include "protocol/solver.hpp"

namespace duet::protocol {

/// What every solver program takes on its command line: --connect ADDRESS.
struct Arguments {
    std::string connect;         ///< the orchestrator's control address
    double connect_timeout = 10; ///< s
};

/// Reads `--connect ADDRESS`; prints a sentence and exits with 2 on anything else (0 for --help and
/// --version).
Arguments parse_arguments(int argc, char** argv);

/// Serves one run. Returns the process's exit status: 0 after Finish, 1 after a failure (already
/// reported to the orchestrator, or on standard error when there is none). Never throws.
int participate(SolidSolver& solid, const Arguments& arguments);
int participate(FluidSolver& fluid, const Arguments& arguments);

} // namespace duet::protocol
