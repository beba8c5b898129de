#include "values/stream_function.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "common/errors.hpp"
#include "files/number_text.hpp"
#include "mesh/faces.hpp"

namespace suffuse {
namespace {

using Edge = std::array<int, 2>;

/// Share of the discharge that may be round-off, also in snapshots of single precision.
constexpr double round_off = 1e-6;
/// Sums along edges that contradict one another by less than this share of psi need no least
/// squares.
constexpr double contradiction = 1e-10;
/// Gradient of the head below which liquid is at rest: round-off causes such gradients.
constexpr double rest = 1e-10;

/// Disjoint sets of numbers, which can be joined.
class Groups {
 public:
  explicit Groups(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int first(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int i, int j) {
    i = first(i);
    j = first(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

const BoundarySet<2>* find_set(const Mesh<2>& mesh, const std::string& name) {
  const auto found = std::ranges::find(mesh.boundaries, name, &BoundarySet<2>::name);
  return found == mesh.boundaries.end() ? nullptr : &*found;
}

/// The representative of each node: of two nodes on the sides of a leaky wall, the first.
std::vector<int> joined_nodes(const ElementFlow& flow) {
  const Mesh<2>& mesh = flow.mesh;
  Groups groups(mesh.node_count());
  for (const auto& name : flow.leaky_walls) {
    const auto* wall = find_set(mesh, name);
    if (wall == nullptr) continue;
    for (std::size_t f = 0; f + 1 < wall->faces.size(); f += 2) {
      for (const int a : wall->faces[f]) {
        const auto distance = [&](int b) { return (mesh.nodes[a] - mesh.nodes[b]).norm(); };
        groups.join(a, *std::ranges::min_element(wall->faces[f + 1], {}, distance));
      }
    }
  }
  std::vector<int> joined(mesh.nodes.size());
  for (int i = 0; i < mesh.node_count(); ++i) joined[i] = groups.first(i);
  return joined;
}

/// q turned to the left, the gradient of psi: what crosses a step dx from left to right is q_x dy -
/// q_y dx.
Vector<2> psi_gradient(const ElementFlow& flow, int e) {
  return {-flow.flux[2 * static_cast<std::size_t>(e) + 1],
          flow.flux[2 * static_cast<std::size_t>(e)]};
}

double growth(const ElementFlow& flow, int e, const Edge& edge) {
  return psi_gradient(flow, e).dot(flow.mesh.nodes[edge[1]] - flow.mesh.nodes[edge[0]]);
}

/// An edge of one element only, in the element's order: soil is to its left.
struct OuterEdge {
  Edge nodes;
  double outflow;  ///< m3/s per metre of thickness
};

/// The outer edges of the model; both sides of leaky walls are inside.
std::vector<OuterEdge> outer_edges_of(const ElementFlow& flow) {
  const Mesh<2>& mesh = flow.mesh;
  const FaceTable<2> faces(mesh);
  std::vector<Edge> inside;
  for (const auto& name : flow.leaky_walls) {
    const auto* wall = find_set(mesh, name);
    if (wall == nullptr) continue;
    for (const auto& face : wall->faces) inside.push_back(face_key<2>(face));
  }
  std::ranges::sort(inside);
  std::vector<OuterEdge> edges;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a < 3; ++a) {
      const Edge edge = face_opposite<2>(mesh.elements[e], a);
      if (faces.owners(edge) != 1) continue;
      if (std::ranges::binary_search(inside, face_key<2>(edge))) continue;
      edges.push_back({edge, growth(flow, e, edge)});
    }
  }
  return edges;
}

double inflow_of(const std::vector<OuterEdge>& edges) {
  double sum = 0.0;
  for (const auto& edge : edges) sum += std::max(0.0, -edge.outflow);
  return sum;
}

std::string boundary_at(const Mesh<2>& mesh, const std::vector<Edge>& edges) {
  for (const auto& set : mesh.boundaries) {
    for (const auto& face : set.faces) {
      if (std::ranges::find(edges, face_key<2>(face)) != edges.end()) return set.name;
    }
  }
  return "";
}

/// A neighbour of a node along an edge, and the growth of psi on the way to it.
struct Step {
  int to;
  double growth;
};

/// Values of psi: sums along edges, from the first node of each connected part on.
std::vector<double> summed(const ElementFlow& flow, const std::vector<int>& joined,
                           std::vector<int>& starts) {
  const Mesh<2>& mesh = flow.mesh;
  std::vector<std::vector<Step>> steps(mesh.nodes.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int a = 0; a < 3; ++a) {
      const Edge edge = face_opposite<2>(mesh.elements[e], a);
      const double d = growth(flow, e, edge);
      steps[joined[edge[0]]].push_back({joined[edge[1]], d});
      steps[joined[edge[1]]].push_back({joined[edge[0]], -d});
    }
  }
  std::vector<double> psi(mesh.nodes.size(), std::numeric_limits<double>::quiet_NaN());
  for (int start = 0; start < mesh.node_count(); ++start) {
    if (joined[start] != start || !std::isnan(psi[start])) continue;
    starts.push_back(start);
    psi[start] = 0.0;
    std::vector<int> reached{start};
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (const Step& step : steps[reached[i]]) {
        if (!std::isnan(psi[step.to])) continue;
        psi[step.to] = psi[reached[i]] + step.growth;
        reached.push_back(step.to);
      }
    }
  }
  return psi;
}

/// Gradients of the three linear shape functions of an element.
std::array<Vector<2>, 3> shape_gradients(const Mesh<2>& mesh, int e) {
  std::array<Vector<2>, 3> gradients;
  const double twice = 2.0 * element_volume(mesh, e);
  for (int a = 0; a < 3; ++a) {
    const auto edge = face_opposite<2>(mesh.elements[e], a);
    const Vector<2> way = mesh.nodes[edge[1]] - mesh.nodes[edge[0]];
    gradients.at(a) = Vector<2>(-way[1], way[0]) / twice;
  }
  return gradients;
}

/// Difference between the exact and the present gradient of psi in each element.
std::vector<Vector<2>> lacks(const ElementFlow& flow, const std::vector<int>& joined,
                             const std::vector<double>& psi) {
  std::vector<Vector<2>> result;
  for (int e = 0; e < flow.mesh.element_count(); ++e) {
    Vector<2> lack = psi_gradient(flow, e);
    const auto gradients = shape_gradients(flow.mesh, e);
    for (int a = 0; a < 3; ++a) lack -= psi[joined[flow.mesh.elements[e][a]]] * gradients.at(a);
    result.push_back(lack);
  }
  return result;
}

/// Root mean square of that difference over the area, relative to the flux.
double misfit_of(const ElementFlow& flow, const std::vector<Vector<2>>& lack) {
  double missed = 0.0;
  double all = 0.0;
  for (int e = 0; e < flow.mesh.element_count(); ++e) {
    const double area = element_volume(flow.mesh, e);
    missed += area * lack[e].squaredNorm();
    all += area * psi_gradient(flow, e).squaredNorm();
  }
  return all > 0.0 ? std::sqrt(missed / all) : 0.0;
}

/// Adds the correction of psi that minimises the squares of that difference.
void add_least_squares(const ElementFlow& flow, const std::vector<int>& joined,
                       const std::vector<int>& starts, const std::vector<Vector<2>>& lack,
                       std::vector<double>& psi) {
  const int n = flow.mesh.node_count();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (int e = 0; e < flow.mesh.element_count(); ++e) {
    const double area = element_volume(flow.mesh, e);
    const auto gradients = shape_gradients(flow.mesh, e);
    for (int a = 0; a < 3; ++a) {
      const int i = joined[flow.mesh.elements[e][a]];
      right[i] += area * gradients.at(a).dot(lack[e]);
      for (int b = 0; b < 3; ++b) {
        entries.emplace_back(i, joined[flow.mesh.elements[e][b]],
                             area * gradients.at(a).dot(gradients.at(b)));
      }
    }
  }
  // The correction is 0 at the start of each part and at nodes that another node represents.
  for (const int start : starts) entries.emplace_back(start, start, 1.0);
  for (int i = 0; i < n; ++i) {
    if (joined[i] != i) entries.emplace_back(i, i, 1.0);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const Eigen::VectorXd added = factor.solve(right);
  for (int i = 0; i < n; ++i) psi[i] += added[i];
}

/// Shifts psi of each connected part so that its least value is 0.
void start_at_zero(const ElementFlow& flow, const std::vector<int>& joined,
                   std::vector<double>& psi) {
  Groups parts(flow.mesh.node_count());
  for (const auto& nodes : flow.mesh.elements) {
    parts.join(joined[nodes[0]], joined[nodes[1]]);
    parts.join(joined[nodes[0]], joined[nodes[2]]);
  }
  std::map<int, double> least;
  for (int i = 0; i < flow.mesh.node_count(); ++i) {
    psi[i] = psi[joined[i]];
    const auto [found, is_new] = least.try_emplace(parts.first(joined[i]), psi[i]);
    found->second = std::min(found->second, psi[i]);
  }
  for (int i = 0; i < flow.mesh.node_count(); ++i) psi[i] -= least.at(parts.first(joined[i]));
}

}  // namespace

std::vector<InnerSource> inner_sources(const ElementFlow& flow) {
  const Mesh<2>& mesh = flow.mesh;
  const auto joined = joined_nodes(flow);
  const auto edges = outer_edges_of(flow);
  Groups groups(mesh.node_count());
  for (const auto& edge : edges) groups.join(joined[edge.nodes[0]], joined[edge.nodes[1]]);
  struct Loop {
    double outflow = 0.0;
    double area = 0.0;  ///< positive around the model, zero or negative around what is inside
    std::vector<Edge> edges;
  };
  std::map<int, Loop> loops;
  double area = 0.0;
  for (const auto& [nodes, outflow] : edges) {
    const Vector<2> a = mesh.nodes[nodes[0]] - mesh.nodes.front();
    const Vector<2> b = mesh.nodes[nodes[1]] - mesh.nodes.front();
    Loop& loop = loops[groups.first(joined[nodes[0]])];
    loop.outflow += outflow;
    loop.area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    loop.edges.push_back(face_key<2>(nodes));
  }
  const double inflow = inflow_of(edges);
  std::vector<InnerSource> sources;
  for (const auto& [first, loop] : loops) {
    if (loop.area > 1e-9 * area || std::abs(loop.outflow) <= round_off * inflow) continue;
    sources.push_back({boundary_at(mesh, loop.edges), -loop.outflow});
  }
  return sources;
}

StreamFunction stream_function(const ElementFlow& flow) {
  StreamFunction result;
  const auto joined = joined_nodes(flow);
  std::vector<int> starts;
  std::vector<double> psi = summed(flow, joined, starts);
  auto lack = lacks(flow, joined, psi);
  if (misfit_of(flow, lack) > contradiction) {
    add_least_squares(flow, joined, starts, lack, psi);
    lack = lacks(flow, joined, psi);
  }
  result.misfit = misfit_of(flow, lack);
  start_at_zero(flow, joined, psi);
  result.at_nodes = std::move(psi);
  result.discharge = inflow_of(outer_edges_of(flow));
  return result;
}

bool flows(const ResultsReader& results, std::size_t index) {
  double flux = 0.0;
  for (const double q : results.field(index, "cell", "darcy_flux").values) {
    flux = std::max(flux, std::abs(q));
  }
  double conductivity = 0.0;
  for (const Soil& soil : results.scene().scene.soils) {
    conductivity = std::max(conductivity, soil.conductivity);
  }
  return flux > rest * conductivity;
}

StreamFunction stream_function(const ResultsReader& results, std::size_t index, const Mesh<2>& mesh,
                               const std::string& command) {
  ElementFlow flow{mesh, results.field(index, "cell", "darcy_flux").values, {}};
  for (const Wall& wall : results.scene().scene.walls) {
    if (wall.conductance > 0.0) flow.leaky_walls.push_back(wall.on);
  }
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw InputError(std::vector{
        InputProblem{command, "RESULTS", results.folder() + ", " + found, expected, ""}});
  };
  if (!flows(results, index)) {
    refuse("where the liquid is at rest", "a flow, which has streamlines");
  }
  const auto sources = inner_sources(flow);
  if (!sources.empty()) {
    const InnerSource& source = sources.front();
    refuse("where " + number_text(std::abs(source.discharge)) + " m3/s " +
               (source.discharge > 0.0 ? "enter" : "leave") + " inside the model" +
               (source.boundary.empty() ? "" : " at \"" + source.boundary + "\""),
           "a flow through the outer edge only: around a well or drain no streamlines have equal "
           "discharge between them");
  }
  return stream_function(flow);
}

}  // namespace suffuse
