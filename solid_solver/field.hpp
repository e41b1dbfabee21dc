// Numbers that a case may give as constants, formulas or tables.

#pragma once

#include "solid_solver/mesh.hpp"

#include <functional>

namespace duet::solid {

/// A constant, or a function of the reference place and the time.
class Field {
  public:
    using Function = std::function<double(const Point&, double time)>;

    Field(double constant = 0) : constant_(constant) {}
    explicit Field(Function function, bool in_time = true)
        : function_(std::move(function)), in_time_(in_time) {}

    double operator()(const Point& place, double time) const {
        return function_ ? function_(place, time) : constant_;
    }
    bool steady() const { return !function_ || !in_time_; } ///< the same at all times
    bool zero() const { return !function_ && constant_ == 0; }

  private:
    double constant_ = 0;
    Function function_;
    bool in_time_ = false;
};

struct VectorField {
    Field x, y;

    VectorField() = default;
    VectorField(const Point& constant) : x(constant.x()), y(constant.y()) {}
    VectorField(Field along_x, Field along_y) : x(std::move(along_x)), y(std::move(along_y)) {}

    Point operator()(const Point& place, double time) const {
        return {x(place, time), y(place, time)};
    }
    bool steady() const { return x.steady() && y.steady(); }
    bool zero() const { return x.zero() && y.zero(); }
};

} // namespace duet::solid
