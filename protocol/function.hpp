// The scene's functions of place and time, ready to be evaluated.

#pragma once

#include "duet/v1/scene.pb.h"

#include <memory>

namespace duet::protocol {

/// A number, a formula of x, y and t, or a table in time. Copies share one formula: evaluate them
/// from one thread at a time.
class Function {
  public:
    /// Throws std::invalid_argument with a sentence if the formula cannot be read, or a table has
    /// no entries, unequal columns, or times that do not rise.
    explicit Function(const v1::Function& function);

    /// The value at (x, y), m, and time t, s. Throws std::runtime_error with a sentence if a
    /// formula has no finite value there.
    double operator()(double x, double y, double t) const;

    bool depends_on_time() const;
    bool depends_on_place() const;

  private:
    struct Formula;

    v1::Function function_;
    std::shared_ptr<Formula> formula_;
};

/// It is the plain number 0, or absent.
bool is_zero(const v1::Function& function);
bool is_zero(const v1::VectorFunction& function);

/// The value of a function that is a plain number (0 if it is absent); throws
/// std::invalid_argument saying `what` must be one otherwise.
double number_of(const v1::Function& function, const char* what);

} // namespace duet::protocol
