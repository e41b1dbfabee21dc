#include "protocol/version.hpp"

namespace duet::protocol {

namespace {

std::string text_of(const v1::Version& version) {
    return std::to_string(version.major()) + "." + std::to_string(version.minor());
}

} // namespace

v1::Version version() {
    v1::Version version;
    version.set_major(2);
    version.set_minor(1);
    return version;
}

bool compatible(const v1::Version& ours, const v1::Version& theirs) {
    return ours.major() == theirs.major();
}

std::string incompatibility(const std::string& we,
                            const v1::Version& ours,
                            const std::string& they,
                            const v1::Version& theirs) {
    const std::string& older = theirs.major() < ours.major() ? they : we;
    return they + " speaks protocol " + text_of(theirs) + ", " + we + " speaks " + text_of(ours)
           + ": the major versions must agree; upgrade " + older + ".";
}

std::string name_of(v1::Role role) {
    switch (role) {
    case v1::ROLE_SOLID:
        return "solid";
    case v1::ROLE_FLUID:
        return "fluid";
    default:
        return "stranger";
    }
}

} // namespace duet::protocol
