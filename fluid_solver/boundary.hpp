// The fluid's boundary: closed loops of straight segments, made of the cavity's walls and the
// solids' interface, with the fluid to the right of the direction of travel.

#pragma once

#include "fluid_solver/lanes.hpp"
#include "fluid_solver/particles.hpp"
#include "fluid_solver/scene.hpp"
#include "fluid_solver/vector.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace duet::fluid {

constexpr std::uint32_t none = ~std::uint32_t{0};

/// One straight piece between two nodes that carry the wall's values.
struct Segment {
    Vec2 a, b;
    std::uint32_t node_a = 0, node_b = 0;
    std::uint32_t wall = none; ///< index into Config::walls of a named wall
    double length = 0;
    double face_start = 0;        ///< arc length along its face where it starts
    std::uint32_t first_cell = 0; ///< of its wall cells
    std::uint32_t cells = 0;
};

/// A maximal run of segments on one line with one thermal condition. Faces that follow one another
/// with hardly a turn make a *run*: to a particle a bent wall is one wall.
struct Face {
    Vec2 a, b;    ///< from a to b
    Vec2 tangent; ///< direction of travel
    Vec2 normal;  ///< from the fluid into the wall
    double length = 0;
    std::uint32_t first = 0, segments = 0;
    bool heated = false;   ///< its temperature is known (a wall's or the solid's); adiabatic if not
    bool slip = false;     ///< the velocity is known across it alone
    bool endless = false;  ///< in a periodic direction: goes on where it began
    std::uint32_t run = 0; ///< the first face of its run
    double run_before = 0, run_after = 0; ///< arc length of the run before and after this face

    /// Whether a component of the velocity is known at the face; else its slope along n is zero.
    bool knows_u() const { return !slip || std::abs(normal.x) > 0.5; }
    bool knows_v() const { return !slip || std::abs(normal.y) > 0.5; }
};

/// A piece of a segment, about half a spacing long, on which flux and traction are taken.
struct WallCell {
    std::uint32_t segment = 0;
    double centre = 0; ///< along the segment, 0..1
    double length = 0;
    Vec2 normal; ///< from the fluid into the wall
    bool heated = false, slip = false;
    bool one_temperature = false;              ///< of a wall, the same everywhere and at all times
    std::uint32_t before = none, after = none; ///< neighbours, unless a corner lies between
    double curvature = 0; ///< div n, 1/m: positive where the fluid lies inside the bend
};

/// A run of faces as seen by one particle: its tangent at the foot point, as long as the run.
struct Contact {
    const Face* face = nullptr; ///< the one that holds the foot point
    double distance = 0;        ///< of the particle from the tangent, positive
    double foot = 0;            ///< arc length of its foot point along the face
    Vec2 normal, tangent;       ///< of the wall there: from the fluid into the wall, and of travel
    double before() const { return face->run_before + foot; } ///< of the run, from the foot
    double after() const { return face->run_after + face->length - foot; }
    bool on_wall() const { return before() >= 0 && after() >= 0; }
};

double distance_to_segment(Vec2 x, Vec2 a, Vec2 b);

/// Corners of a polygon that stands for a circle: as many that its sides deviate from it by less
/// than 0.02 spacings and are no longer than two, on a radius that makes the areas equal.
std::vector<Vec2> circle(Vec2 centre, double radius, double spacing);

/// Values of the wall at a point: lanes u, v, 0, T. Where the temperature is not known, T holds its
/// slope along the normal instead, K/m.
struct WallPoint {
    Lanes value;
    Vec2 acceleration;
    const Segment* segment;
    double along; ///< of the segment, 0..1
};

class Boundary {
  public:
    /// Throws SceneError if chains and region do not fit each other.
    Boundary(const Config& config, const std::vector<Chain>& chains, const InterfaceState& state);

    /// Moves the interface. Rebuilds the geometry only if a node has moved.
    void place(const std::vector<Vec2>& positions);

    /// Sets the values of the walls to those of the time, s.
    void set_walls(double time);

    /// Sets the values of the interface nodes: velocity, acceleration, temperature.
    void set_values(std::span<const Vec2> velocity,
                    std::span<const Vec2> acceleration,
                    std::span<const double> temperature);

    /// Runs within the support of x that show it their outer side. `contacts` is overwritten.
    void contacts(Vec2 x, std::vector<Contact>& contacts) const;

    /// Whether any face may lie within the support of a point in the cell of x.
    bool near(Vec2 x) const {
        const std::size_t c = grid_.index(x);
        return candidate_start_[c] != candidate_start_[c + 1];
    }

    /// The wall at an arc length along a face; beyond its ends, along its run.
    WallPoint at(const Face& face, double arc) const;
    std::uint32_t cell_at(const Segment& segment, double along) const;

    /// Signed distance of x from the nearest face within the support (positive in the fluid), the
    /// face and the nearest point on it. If none is in range, `face` is null and the distance is
    /// the support.
    struct Nearest {
        const Face* face = nullptr;
        double distance = 0;
        Vec2 point;
        double foot = 0;
    };
    Nearest nearest(Vec2 x) const;

    /// Where a point crosses a segment from the fluid's side.
    struct Crossing {
        std::uint32_t segment = none;
        double along = 0; ///< of the segment, 0..1: the foot of the point's end, or the next end
        double depth = 0; ///< m, of the point's end behind the segment
        Vec2 shift;       ///< from the segment to its image that was crossed; else zero
    };
    /// The first segment that a point crosses on its straight way between `from` and `to`, while
    /// each interface node goes straight from its place in `before` to its present one. Sees the
    /// segments within the support of `to`.
    std::optional<Crossing> first_crossing(Vec2 from, Vec2 to, std::span<const Vec2> before) const;
    /// The place of a point of a segment, now or with the interface nodes at `before`.
    Vec2 place_on(const Segment& segment, double along) const {
        return (1 - along) * segment.a + along * segment.b;
    }
    Vec2 place_on(const Segment& segment, double along, std::span<const Vec2> before) const;
    /// A gap between a segment's start and a face before it that does not hang together with it
    /// nearby; either side is the interface's. A part is a chain, by its index, or the walls, which
    /// come last.
    struct Gap {
        double width; ///< m
        const Segment* from;
        const Segment* opposite;
        std::size_t part, opposite_part;
    };
    /// All gaps narrower than `within` m, at most the support. `gaps` is overwritten.
    void find_gaps(double within, std::vector<Gap>& gaps) const;
    std::size_t parts() const { return chains_.size() + 1; }
    /// How far an image of a face is from the face itself; zero for the face.
    Vec2 image_shift(const Face& face) const { return face.a - segments_[face.first].a; }
    /// A segment's name for a message: "wall 'hot'", "the surface of 'beam'".
    std::string name(const Segment& segment) const;

    /// Whether x lies in the fluid, by the parity of crossings. O(faces).
    bool contains(Vec2 x) const;
    /// Distance of x from the boundary. O(faces).
    double distance(Vec2 x) const;
    double area() const;

    const std::vector<Segment>& segments() const { return segments_; }
    /// The faces, and after them the images of those that are seen over a periodic side.
    const std::vector<Face>& faces() const { return faces_; }
    const std::vector<WallCell>& cells() const { return cells_; }
    const CellGrid& grid() const { return grid_; }
    std::size_t interface_segments() const { return interface_segments_; }
    std::size_t interface_nodes() const { return interface_nodes_; }
    /// Length of each wall of the configuration that is left beside leaning solids.
    const std::vector<double>& wall_length() const { return wall_length_; }
    /// Whether there is no wall and no interface at all.
    bool none_at_all() const { return segments_.empty(); }
    /// Whether heat can pass: a wall or the interface has a temperature, or a wall a heat flux.
    bool heated() const;
    /// Largest speed of a wall or an interface node, m/s.
    double speed() const;
    Vec2 velocity(std::uint32_t node) const { return velocity_[node]; }
    double temperature(std::uint32_t node) const { return temperature_[node]; }

  private:
    struct Side {
        Vec2 a, b;
        std::uint32_t wall = none;
        bool seam = false; ///< of a periodic region: no wall
    };
    /// A node of a wall, and the direction in which it can move.
    struct WallNode {
        std::uint32_t node;
        Vec2 place, along;
        std::uint32_t wall;
    };

    // contact.cpp
    struct Arcs {
        std::vector<std::uint32_t> chain; ///< of each interface segment
        std::vector<double> start;        ///< m, along its chain
        std::vector<double> length;       ///< m, of each chain
    };
    Arcs arcs() const;
    double way_along(const Arcs& arcs, std::uint32_t j, const Face& face, double foot) const;

    // walls.cpp
    void add_loop(std::vector<Vec2> corners, bool hole);
    void check_turning(const Wall& wall, const Side& side) const;
    void check_slip(const Wall& wall, const Side& side) const;
    void assign_walls();
    void add_walls();
    void keep(const std::vector<Side>& loop, double from, double to);
    void add_side(const Side& side);
    void link_sides(std::size_t first_face);
    double perimeter_position(Vec2 x, std::size_t& loop) const;

    // seams.cpp
    void open_seams(const Config& config);
    void check_clear_of_seams(std::span<const Vec2> places, const std::string& what) const;
    void close_over_seams(std::size_t first_face);
    void add_images(std::size_t first_face, std::size_t end);
    bool in_reach(Vec2 x) const;

    void build();
    void add_chain(const Chain& chain);
    void add_face(std::uint32_t first, std::uint32_t segments, bool heated, bool slip);
    void find_runs(std::uint32_t first);
    void add_cells(std::uint32_t segment, const Face& face);
    void link_cells(const Chain& chain, std::uint32_t first);
    void link(const Segment& from, const Segment& to);
    void bend_cells();
    void register_faces();

    double spacing_, support_;
    std::vector<Chain> chains_;
    std::vector<std::vector<Side>> loops_; ///< the region's sides, then those of the holes
    std::vector<Side> seams_;              ///< sides of the region that are no walls
    std::vector<Wall> walls_;
    double conductivity_;
    Periodic periodic_;
    double time_ = 0;
    std::vector<WallNode> wall_nodes_;
    std::vector<double> wall_length_;
    std::size_t interface_nodes_ = 0, interface_segments_ = 0;

    std::vector<Vec2> position_; ///< of the interface nodes
    std::vector<Segment> segments_;
    std::vector<Face> faces_;
    std::vector<std::size_t> first_face_; ///< of each chain, then of each loop
    std::vector<WallCell> cells_;
    std::vector<Vec2> velocity_,
        acceleration_; ///< by node: interface first, then those of each side
    std::vector<double> temperature_;

    Vec2 lower_, upper_; ///< corners of the box round the region
    CellGrid grid_;
    std::vector<std::uint32_t> candidate_start_, candidate_, cursor_;
};

} // namespace duet::fluid
