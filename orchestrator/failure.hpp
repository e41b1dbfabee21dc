// The one line that a failed run ends with: who, when, what.

#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace duet::orchestrator {

/// When something happened: before the first window, or in a window at a simulated time.
struct When {
    std::optional<std::uint64_t> window;
    double time = 0; ///< s
};

class Failure : public std::runtime_error {
  public:
    /// `who`: "the fluid", "the orchestrator". `direct`: seen at its source; else one side's word
    /// about the other, which a direct sight outweighs.
    Failure(const std::string& who, const When& when, const std::string& what, bool direct = true);

    const std::string& who() const { return who_; }
    const std::string& sentence() const { return sentence_; }
    const When& when() const { return when_; }
    bool direct() const { return direct_; }

  private:
    std::string who_;
    std::string sentence_;
    When when_;
    bool direct_;
};

/// Somebody asked the run to end at once.
class Interrupted : public std::exception {};

} // namespace duet::orchestrator
