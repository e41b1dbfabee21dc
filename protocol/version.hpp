// The version of the protocol, and the one rule by which two versions fit.

#pragma once

#include "duet/v1/coupling.pb.h"

#include <string>

namespace duet::protocol {

/// The version this library speaks.
v1::Version version();

/// The same major fits; a minor only adds what the other side may ignore.
bool compatible(const v1::Version& ours, const v1::Version& theirs);

/// One sentence naming both versions and who must be brought up to date. `we` and `they` are the
/// names of the programs.
std::string incompatibility(const std::string& we,
                            const v1::Version& ours,
                            const std::string& they,
                            const v1::Version& theirs);

/// "solid" or "fluid"; "stranger" for a connection that has not said who it is.
std::string name_of(v1::Role role);

} // namespace duet::protocol
