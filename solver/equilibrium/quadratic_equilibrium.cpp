#include "equilibrium/quadratic_equilibrium.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <set>

#include "equilibrium/first_tangent.hpp"
#include "grid/element_field.hpp"
#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Threads pay off from this number of elements on.
constexpr int enough_elements = 64;
/// Sum of squared cosines with the ways to other elements, below which none counts as lying along
/// an axis.
constexpr double least_moment = 1e-3;

template <int Dim>
std::array<double, Dim + 1> barycentric_of_point(int point) {
  std::array<double, Dim + 1> at;
  at.fill(FieldNodes<Dim>::far_vertex);
  at[point] = FieldNodes<Dim>::near_vertex;
  return at;
}

template <int Dim>
int nearest_point(const SolidBody<Dim>& body, int e, const Vector<Dim>& x) {
  const auto farther = [&](int p, int q) {
    return (body.points.position[p] - x).squaredNorm() <
           (body.points.position[q] - x).squaredNorm();
  };
  return *std::ranges::min_element(body.sorted.of(e), farther);
}

/// Nodes and edges of the elements that have points.
template <int Dim>
std::vector<char> in_use(const QuadraticShapes<Dim>& shapes, const std::vector<int>& elements) {
  std::vector<char> used(shapes.size(), 0);
  for (const int e : elements) {
    for (const int i : shapes.of_element(e)) used[i] = 1;
  }
  return used;
}

/// Neighbours of an element across its faces, and their neighbours, if they have points and are in
/// its region.
template <int Dim>
std::set<int> elements_around(const SolidBody<Dim>& body, int e) {
  std::set<int> found{e};
  for (int ring = 0; ring < 2; ++ring) {
    for (const int of : std::set<int>(found)) {
      for (int k = 0; k <= Dim; ++k) {
        const int next = body.grid.across(of, k);
        const std::vector<int>& region = body.grid.mesh.element_region;
        if (next >= 0 && !body.sorted.is_empty(next) && region[next] == region[e])
          found.insert(next);
      }
    }
  }
  found.erase(e);
  return found;
}

/// Gradient of values of elements at one of them, by weighted least squares, 1/m. A direction in
/// which no other element lies has none.
template <int Dim>
Vector<Dim> fitted_gradient(const SolidBody<Dim>& body, const std::vector<double>& value, int e) {
  Eigen::Matrix<double, Dim, Dim> moments = Eigen::Matrix<double, Dim, Dim>::Zero();
  Vector<Dim> slope = Vector<Dim>::Zero();
  const Vector<Dim> centre = element_centroid(body.grid.mesh, e);
  for (const int other : elements_around(body, e)) {
    const Vector<Dim> way = element_centroid(body.grid.mesh, other) - centre;
    const double weight = 1.0 / way.squaredNorm();
    moments += weight * way * way.transpose();
    slope += weight * (value[other] - value[e]) * way;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim, Dim>> axes(moments);
  Vector<Dim> gradient = Vector<Dim>::Zero();
  for (int k = 0; k < Dim; ++k) {
    if (axes.eigenvalues()[k] < least_moment) continue;
    const Vector<Dim> axis = axes.eigenvectors().col(k);
    gradient += axis.dot(slope) / axes.eigenvalues()[k] * axis;
  }
  return gradient;
}

}  // namespace

template <int Dim>
QuadraticEquilibrium<Dim>::QuadraticEquilibrium(const SolidBody<Dim>& body,
                                                const Supports<Dim>& supports,
                                                const QuadraticShapes<Dim>& shapes, int threads)
    : body_(body),
      shapes_(shapes),
      threads_(threads),
      elements_(elements_with_points(body)),
      supports_(supports.with_edges(body.grid, shapes)),
      unknowns_(supports_, in_use(shapes, elements_)),
      soil_volume_(soil_volumes(body.points, body.sorted, body.classes)),
      soft_(soil_volume_.size(), 0.0),
      quadrature_(soil_volume_.size()),
      force_(soil_volume_.size(), Gradients::Zero()) {
  for (const int e : elements_) {
    for (int q = 0; q < points; ++q) {
      quadrature_[e][q].solid_point =
          nearest_point(body, e, FieldNodes<Dim>::position(body.grid.mesh, e, q));
    }
  }
  double sum = 0.0;
  for (const int e : elements_) {
    double young = 0.0;
    double modulus = 0.0;
    for (const QuadraturePoint& at : quadrature_[e]) {
      const SkeletonParameters& parameters = body_.skeleton[at.solid_point].parameters;
      young += parameters.young / points;
      modulus += (parameters.lame() + 2.0 * parameters.shear_modulus()) / points;
    }
    soft_[e] = (1.0 - body_.classes.full[e]) * body_.soft.gradient * body_.grid.volume[e] * young;
    for (const Vector<Dim>& g : body_.grid.shape_gradient[e]) {
      sum += (modulus * soil_volume_[e] * g).squaredNorm();
    }
  }
  least_force_ = this->least_strain * std::sqrt(sum);
}

template <int Dim>
void QuadraticEquilibrium<Dim>::set_pressure(const std::vector<double>& pressure) {
  if (pressure.empty()) return;
  for_each_element([&](int e) {
    const Vector<Dim> gradient = fitted_gradient(body_, pressure, e);
    const Vector<Dim> centre = element_centroid(body_.grid.mesh, e);
    for (int q = 0; q < points; ++q) {
      const Vector<Dim> way = FieldNodes<Dim>::position(body_.grid.mesh, e, q) - centre;
      quadrature_[e][q].pressure = pressure[e] + gradient.dot(way);
    }
  });
  displacement_.clear();
}

template <int Dim>
auto QuadraticEquilibrium<Dim>::gradients_at(int e, int q) const -> Gradients {
  return shapes_.gradients(e, barycentric_of_point<Dim>(q));
}

template <int Dim>
auto QuadraticEquilibrium<Dim>::displacement_gradient(int e, const Gradients& shapes,
                                                      const NodeVectors<Dim>& displacement) const
    -> Gradient {
  Gradient result = Gradient::Zero();
  for (int k = 0; k < count; ++k) {
    result += displacement[shapes_.of_element(e)[k]] * shapes.col(k).transpose();
  }
  return result;
}

template <int Dim>
bool QuadraticEquilibrium<Dim>::is_possible(const NodeVectors<Dim>& displacement) const {
  for (const int e : elements_) {
    for (int q = 0; q < points; ++q) {
      const Gradient f =
          Gradient::Identity() + displacement_gradient(e, gradients_at(e, q), displacement);
      if (!(f.determinant() > Equilibrium<Dim>::min_ratio)) return false;
    }
  }
  return true;
}

template <int Dim>
void QuadraticEquilibrium<Dim>::for_each_element(const auto& call) const {
  for_each_index(
      static_cast<int>(elements_.size()), threads_, [&](int k) { call(elements_[k]); },
      enough_elements);
}

template <int Dim>
void QuadraticEquilibrium<Dim>::displace(const NodeVectors<Dim>& displacement, bool with_tangents) {
  if (displacement == displacement_ && (has_tangents_ || !with_tangents)) return;
  displacement_ = displacement;
  has_tangents_ = with_tangents;
  for_each_element([&](int e) { respond(e); });
}

/// Sets the forces of an element, and the tangents of its laws if they are wanted.
template <int Dim>
void QuadraticEquilibrium<Dim>::respond(int e) {
  force_[e].setZero();
  for (int q = 0; q < points; ++q) {
    QuadraturePoint& at = quadrature_[e][q];
    const Gradients shapes = gradients_at(e, q);
    const Gradient moved = displacement_gradient(e, shapes, displacement_);
    const Gradient f = Gradient::Identity() + moved;
    const auto& [law, parameters] = body_.skeleton[at.solid_point];
    const Gradient inverse = f.inverse();
    Tangent of_stress;
    const Gradient stress =
        skeleton_response<Dim>(*law, parameters, body_.points.skeleton[at.solid_point], f,
                               has_tangents_ ? &of_stress : nullptr)
            .stress.template topLeftCorner<Dim, Dim>();
    if (has_tangents_) at.tangent = first_tangent<Dim>(of_stress, stress, inverse);
    const Gradient of_soil = stress * inverse.transpose();
    force_[e] += (soil_volume_[e] * of_soil + soft_[e] * moved -
                  body_.grid.volume[e] * at.pressure * Gradient::Identity()) /
                 points * shapes;
  }
}

template <int Dim>
NodeVectors<Dim> QuadraticEquilibrium<Dim>::forces() const {
  NodeVectors<Dim> result(shapes_.size(), Vector<Dim>::Zero());
  for (const int e : elements_) {
    for (int k = 0; k < count; ++k) result[shapes_.of_element(e)[k]] += force_[e].col(k);
  }
  return result;
}

template <int Dim>
double QuadraticEquilibrium<Dim>::force_scale() const {
  double sum = 0.0;
  for (const int e : elements_) sum += force_[e].squaredNorm();
  return std::sqrt(sum) + least_force_;
}

template <int Dim>
bool QuadraticEquilibrium<Dim>::share_pattern(Pattern& pattern) {
  if (pattern_ && pattern == pattern_) return true;
  SoilCouplings couplings;
  for (const int e : elements_) {
    couplings.patches.emplace_back(shapes_.of_element(e).begin(), shapes_.of_element(e).end());
  }
  const bool fits = pattern && pattern->couplings() == couplings;
  if (!fits) {
    pattern =
        std::make_shared<StiffnessPattern<Dim>>(body_.grid.mesh, unknowns_, std::move(couplings));
  }
  pattern_ = pattern;
  return fits;
}

/// Adds up the matrices of the elements along the free directions.
/// \param tangent_of  derivative of V tau F^-T by F at a point of an element, Pa m3
template <int Dim>
void QuadraticEquilibrium<Dim>::scatter(const auto& tangent_of,
                                        Eigen::SparseMatrix<double>& matrix) {
  if (!pattern_) share_pattern(pattern_);
  matrix = pattern_->zeros();
  double* const values = matrix.valuePtr();
  Eigen::Matrix<double, Dim * Dim, Eigen::Dynamic, 0, Dim * Dim, Dim * count> strain;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Dim * count, Dim * count> of_element;
  for (std::size_t at = 0; at < elements_.size(); ++at) {
    const int e = elements_[at];
    for (int q = 0; q < points; ++q) {
      const Gradients shapes = gradients_at(e, q);
      strain.resize(Eigen::NoChange, Dim * count);
      int free = 0;
      for (int k = 0; k < count; ++k) {
        const int i = shapes_.of_element(e)[k];
        for (int j = 0; j < unknowns_.count(i); ++j) {
          const Gradient of_one = supports_.directions(i).col(j) * shapes.col(k).transpose();
          strain.col(free++) = of_one.reshaped();
        }
      }
      strain.conservativeResize(Eigen::NoChange, free);
      if (q == 0) of_element.setZero(free, free);
      of_element.noalias() += strain.transpose() * (tangent_of(e, q) * strain);
    }
    const std::vector<int>& slots = pattern_->of_patch(at);
    for (std::size_t k = 0; k < slots.size(); ++k) values[slots[k]] += of_element.data()[k];
  }
}

template <int Dim>
void QuadraticEquilibrium<Dim>::assemble(Eigen::SparseMatrix<double>& tangent) {
  scatter(
      [&](int e, int q) -> Tangent {
        return (soil_volume_[e] * quadrature_[e][q].tangent + soft_[e] * Tangent::Identity()) /
               points;
      },
      tangent);
}

template <int Dim>
void QuadraticEquilibrium<Dim>::assemble_elastic(Eigen::SparseMatrix<double>& stiffness) {
  scatter(
      [&](int e, int q) -> Tangent {
        const SkeletonParameters& parameters =
            body_.skeleton[quadrature_[e][q].solid_point].parameters;
        return (soil_volume_[e] *
                    hooke_tangent<Dim>(parameters.lame(), parameters.shear_modulus()) +
                soft_[e] * Tangent::Identity()) /
               points;
      },
      stiffness);
}

template class QuadraticEquilibrium<2>;
template class QuadraticEquilibrium<3>;

}  // namespace suffuse
