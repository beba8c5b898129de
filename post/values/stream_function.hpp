#pragma once

/// The stream function of a flow: its contour lines are streamlines, with equal discharge between
/// those of equally spaced values.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

struct StreamFunction {
  /// psi at nodes, m2/s (m3/s per metre of thickness), 0 at the least: from one place to another it
  /// grows by the discharge that crosses any line between them from its left side to its right.
  std::vector<double> at_nodes;
  double discharge = 0.0;  ///< inflow through the outer edges, m3/s per metre of thickness
  /// Relative difference between the flux of psi and the given one, both as root mean square over
  /// the area; it is round-off in a flow without sources, such as that of an incompressible liquid.
  double misfit = 0.0;
};

/// A closed part of the edge, inside the model, through which liquid enters or leaves.
struct InnerSource {
  std::string boundary;    ///< name of a boundary there; may be empty
  double discharge = 0.0;  ///< that enters the model there, m3/s per metre of thickness
};

/// A flow on a mesh.
struct ElementFlow {
  const Mesh<2>& mesh;
  std::vector<double> flux;  ///< per element two components of the mean flux, m/s
  /// Walls inside the mesh that let liquid through: psi is the same on both sides.
  std::vector<std::string> leaky_walls;
};

/// Places around which psi has no single value: it would grow by the discharge of such a
/// place with each turn.
std::vector<InnerSource> inner_sources(const ElementFlow& flow);

/// The flux of a flow without sources is constant in each element (Raviart and Thomas's of lowest
/// order), so sums along edges of elements give psi to round-off. Where such sums contradict one
/// another, psi is fitted by least squares over the area. Each connected part of a mesh has its own
/// psi, whose least value is 0.
StreamFunction stream_function(const ElementFlow& flow);

/// Whether liquid flows in a snapshot: round-off does not count. Throws FileError.
bool flows(const ResultsReader& results, std::size_t index);

/// The stream function of a snapshot. Throws InputError, naming `command`, for a place around which
/// it has no single value, and where the liquid is at rest; FileError.
StreamFunction stream_function(const ResultsReader& results, std::size_t index, const Mesh<2>& mesh,
                               const std::string& command);

}  // namespace suffuse
