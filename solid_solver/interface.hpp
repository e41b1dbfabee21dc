// The wet boundary: where the bodies touch the fluid, as ordered chains of nodes.

#pragma once

#include "solid_solver/mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace duet::solid {

struct BodyShape {
    std::string name;
    const Mesh* mesh = nullptr;
    std::vector<Point> place; ///< m, of the nodes at the start
};

struct Interface {
    struct Node {
        std::uint32_t body;
        std::uint32_t node; ///< of the body's mesh
    };
    /// Interface nodes in the order of travel; the fluid lies to the right. Segment j runs from
    /// node[j] to node[j+1]; in a closed chain the last one runs back to node[0].
    struct Chain {
        std::vector<std::uint32_t> node;
        bool closed = false;
        std::size_t segments() const { return closed ? node.size() : node.size() - 1; }
    };
    struct Segment {
        std::uint32_t a, b; ///< interface nodes
    };

    std::vector<Node> node;
    std::vector<Chain> chain;
    std::vector<Segment> segment; ///< of all chains, in their order
};

/// At the start, where displaced bodies may lie elsewhere than in their meshes. The boundary edges
/// that lie strictly inside the region are wet: an edge on the region's own boundary leans on a
/// wall. Nodes are numbered chain by chain, chains by body and first node; a
/// closed chain starts at its lowest node, an open one at the wall it comes from.
/// Throws std::invalid_argument with a sentence if a body leaves the region, two bodies overlap or
/// touch, or a corner of the region lies inside an edge that is partly wet.
Interface wet_interface(const std::vector<BodyShape>& bodies, const std::vector<Point>& region);

} // namespace duet::solid
