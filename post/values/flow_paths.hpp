#pragma once

/// Streamlines of a flow through a mesh of tetrahedra, each with the same share of the discharge.

#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// The path of the liquid from the surface of a model through its elements.
struct FlowPath {
  std::vector<Vector<3>> places;  ///< m; one more than elements
  std::vector<int> elements;      ///< between two places each
};

struct FlowPaths {
  std::vector<FlowPath> paths;
  double discharge = 0.0;  ///< inflow through the surface, m3/s; the paths have equal shares
};

/// `count` paths, which begin at the surface where liquid enters. In each element they follow the
/// mean flux, straight (a flux of Raviart and Thomas of lowest order without sources is constant in
/// an element). A path ends where it leaves the model, where liquid is at rest, and where the flux
/// of the next element leads back.
/// \param flux  three components per element, m/s
FlowPaths flow_paths(const Mesh<3>& mesh, const std::vector<double>& flux, int count);

}  // namespace suffuse
