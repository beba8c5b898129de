#pragma once

/// The elements of a model that hold next to nothing but air, of which maps show nothing.

#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Per element: whether it is in a region without soil, soil that has moved fills less than a third
/// of it, and it is less than half full of water; empty if there is no such region.
template <int Dim>
std::vector<bool> elements_of_air(const ResultsReader& run, std::size_t index,
                                  const Mesh<Dim>& mesh);

/// The mesh without these elements, with the same nodes.
Mesh<2> without(const Mesh<2>& mesh, const std::vector<bool>& elements);

}  // namespace suffuse
