// Two-dimensional vectors and matrices, just large enough for the equations to read as printed.

#pragma once

#include <cmath>

namespace duet::fluid {

struct Vec2 {
    double x = 0, y = 0;

    Vec2& operator+=(Vec2 o) { return x += o.x, y += o.y, *this; }
    Vec2& operator-=(Vec2 o) { return x -= o.x, y -= o.y, *this; }
    Vec2& operator*=(double s) { return x *= s, y *= s, *this; }
    friend Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
    friend Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
    friend Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
    friend Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
    friend bool operator==(Vec2 a, Vec2 b) { return a.x == b.x && a.y == b.y; }
};

inline double dot(Vec2 a, Vec2 b) {
    return a.x * b.x + a.y * b.y;
}
/// The out-of-plane component of the cross product; positive if b lies to the left of a.
inline double cross(Vec2 a, Vec2 b) {
    return a.x * b.y - a.y * b.x;
}
inline double norm(Vec2 a) {
    return std::sqrt(dot(a, a));
}
/// a turned by 90 degrees to the left.
inline Vec2 left(Vec2 a) {
    return {-a.y, a.x};
}

/// The directions in which a region repeats itself without end.
struct Periodic {
    bool x = false, y = false;
    bool any() const { return x || y; }
};

/// A general 2 x 2 matrix.
struct Mat2 {
    double xx = 0, xy = 0, yx = 0, yy = 0;

    Mat2& operator+=(const Mat2& o) {
        return xx += o.xx, xy += o.xy, yx += o.yx, yy += o.yy, *this;
    }
    friend Mat2 operator+(Mat2 a, const Mat2& b) { return a += b; }
    friend Vec2 operator*(const Mat2& m, Vec2 a) {
        return {m.xx * a.x + m.xy * a.y, m.yx * a.x + m.yy * a.y};
    }
};

inline Mat2 operator*(const Mat2& a, const Mat2& b) {
    return {a.xx * b.xx + a.xy * b.yx,
            a.xx * b.xy + a.xy * b.yy,
            a.yx * b.xx + a.yy * b.yx,
            a.yx * b.xy + a.yy * b.yy};
}
inline Mat2 outer(Vec2 a, Vec2 b) {
    return {a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y};
}
inline double determinant(const Mat2& m) {
    return m.xx * m.yy - m.xy * m.yx;
}
/// The inverse; the caller knows that the matrix is regular.
inline Mat2 inverse(const Mat2& m) {
    const double s = 1 / determinant(m);
    return {s * m.yy, -s * m.xy, -s * m.yx, s * m.xx};
}

} // namespace duet::fluid
