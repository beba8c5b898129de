#include "equilibrium/equilibrium.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Threads pay off from this number of elements on.
constexpr int worth_sharing = 256;

template <int Dim>
std::vector<int> elements_with_points(const SolidBody<Dim>& body) {
  std::vector<int> result;
  for (int e = 0; e < body.grid.mesh.element_count(); ++e) {
    if (!body.sorted.is_empty(e)) result.push_back(e);
  }
  return result;
}

template <int Dim>
std::vector<char> nodes_of(const Mesh<Dim>& mesh, const std::vector<int>& elements) {
  std::vector<char> used(mesh.node_count(), 0);
  for (const int e : elements) {
    for (const int i : mesh.elements[e]) used[i] = 1;
  }
  return used;
}

}  // namespace

PointSkeleton skeleton_at(const SkeletonModel& model, double fines_left) {
  if (model.moves()) return {model.law, model.at(fines_left)};
  return {skeleton_law("elastic"), {.young = 1.0}};
}

template <int Dim>
Equilibrium<Dim>::Equilibrium(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                              int threads)
    : body_(body),
      threads_(threads),
      elements_(elements_with_points(body)),
      unknowns_(supports, nodes_of(body.grid.mesh, elements_)) {
  const int count = body.grid.mesh.element_count();
  soft_.assign(count, 0.0);
  inverse_.assign(count, Gradient::Identity());
  ratio_.assign(count, 1.0);
  stress_.assign(count, Gradient::Zero());
  effective_.assign(count, Gradient::Zero());
  soil_volume_ = soil_volumes(body.points, body.sorted, body.classes);
  for (const int e : elements_) {
    if (body.classes.full[e] == 1.0) continue;
    double young = 0.0;
    for (const int p : body.sorted.of(e)) young += body.skeleton[p].parameters.young;
    const auto points = static_cast<double>(body.sorted.of(e).size());
    soft_[e] = (1.0 - body.classes.full[e]) * body.soft * young / points * body.grid.volume[e];
  }
  double sum = 0.0;
  for (const int e : elements_) {
    const double modulus = elastic_tangent(e)(0, 0);
    for (const Vector<Dim>& g : body.grid.shape_gradient[e]) sum += (modulus * g).squaredNorm();
  }
  least_force_ = least_strain * std::sqrt(sum);
  make_pattern();
}

template <int Dim>
auto Equilibrium<Dim>::displacement_gradient(const NodeVectors<Dim>& displacement, int e) const
    -> Gradient {
  Gradient gradient = Gradient::Zero();
  for (int a = 0; a <= Dim; ++a) {
    gradient +=
        displacement[body_.grid.mesh.elements[e][a]] * body_.grid.shape_gradient[e][a].transpose();
  }
  return gradient;
}

template <int Dim>
bool Equilibrium<Dim>::is_possible(const NodeVectors<Dim>& displacement) const {
  for (const int e : elements_) {
    const Gradient f = Gradient::Identity() + displacement_gradient(displacement, e);
    if (!(f.determinant() > min_ratio)) return false;
  }
  return true;
}

template <int Dim>
void Equilibrium<Dim>::displace(const NodeVectors<Dim>& displacement, bool with_tangents) {
  displacement_ = displacement;
  if (with_tangents) tangent_.resize(body_.grid.mesh.element_count());
  for_each_index(
      static_cast<int>(elements_.size()), threads_,
      [&](int k) { displace_element(displacement, with_tangents, elements_[k]); }, worth_sharing);
}

template <int Dim>
void Equilibrium<Dim>::displace_element(const NodeVectors<Dim>& displacement, bool with_tangents,
                                        int e) {
  const Gradient moved = displacement_gradient(displacement, e);
  const Gradient f = Gradient::Identity() + moved;
  ratio_[e] = f.determinant();
  inverse_[e] = f.inverse();
  Gradient& stress = stress_[e];
  stress = soft_[e] * moved;
  if (with_tangents) {
    tangent_[e].setZero();
    tangent_[e].diagonal().setConstant(soft_[e]);
  }
  Eigen::Matrix3d kirchhoff = Eigen::Matrix3d::Zero();  // times volume
  for (const int p : body_.sorted.of(e)) {
    const auto& [law, parameters] = body_.skeleton[p];
    const double volume = body_.classes.scale[e] * body_.points.reference_volume[p];
    Tangent tangent;
    kirchhoff += volume * skeleton_response<Dim>(*law, parameters, body_.points.skeleton[p], f,
                                                 with_tangents ? &tangent : nullptr)
                              .stress;
    if (with_tangents) tangent_[e] += volume * tangent;
  }
  effective_[e] = kirchhoff.template topLeftCorner<Dim, Dim>();
  stress += effective_[e] * inverse_[e].transpose();
  if (!pressure_.empty()) add_pressure(e, with_tangents);
}

/// - p V_e J F^-T and its derivative: d(J F^-T)_iJ / dF_kL = J (F^-1_Ji F^-1_Lk - F^-1_Jk F^-1_Li).
template <int Dim>
void Equilibrium<Dim>::add_pressure(int e, bool with_tangents) {
  const Gradient& inverse = inverse_[e];
  const double stiffness = stiffness_.empty() ? 0.0 : stiffness_[e];
  const double pressure = pressure_[e] - stiffness * (ratio_[e] - 1.0);
  const double factor = -pressure * body_.grid.volume[e] * ratio_[e];
  stress_[e] += factor * inverse.transpose();
  if (!with_tangents) return;
  for (int k = 0; k < Dim; ++k) {
    for (int l = 0; l < Dim; ++l) {
      const Gradient change = inverse.transpose() * inverse(l, k) -
                              inverse.row(l).transpose() * inverse.col(k).transpose();
      tangent_[e].col(k + Dim * l) += factor * change.reshaped();
      if (stiffness == 0.0) continue;
      const double growth = stiffness * ratio_[e] * inverse(l, k);
      tangent_[e].col(k + Dim * l) +=
          growth * body_.grid.volume[e] * ratio_[e] * inverse.transpose().reshaped();
    }
  }
}

template <int Dim>
NodeVectors<Dim> Equilibrium<Dim>::forces() const {
  NodeVectors<Dim> result(body_.grid.mesh.node_count(), Vector<Dim>::Zero());
  for (const int e : elements_) {
    for (int a = 0; a <= Dim; ++a) {
      result[body_.grid.mesh.elements[e][a]] += stress_[e] * body_.grid.shape_gradient[e][a];
    }
  }
  for (std::size_t i = 0; i < inertia_.size(); ++i) result[i] += inertia_force(static_cast<int>(i));
  return result;
}

template <int Dim>
void Equilibrium<Dim>::set_inertia(const std::vector<double>& mass,
                                   const NodeVectors<Dim>& velocity, double dt) {
  inertia_.resize(mass.size());
  coasting_.resize(mass.size());
  for (std::size_t i = 0; i < mass.size(); ++i) {
    inertia_[i] = mass[i] / (dt * dt);
    coasting_[i] = dt * velocity[i];
  }
}

template <int Dim>
double Equilibrium<Dim>::inertia_norm() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < inertia_.size(); ++i) {
    sum += inertia_force(static_cast<int>(i)).squaredNorm();
  }
  return std::sqrt(sum);
}

template <int Dim>
double Equilibrium<Dim>::force_scale() const {
  double sum = 0.0;
  for (const int e : elements_) {
    for (int a = 0; a <= Dim; ++a) {
      sum += (stress_[e] * body_.grid.shape_gradient[e][a]).squaredNorm();
    }
  }
  return std::sqrt(sum) + least_force_;
}

template <int Dim>
NodeVectors<Dim> Equilibrium<Dim>::tangent_times(const NodeVectors<Dim>& displacement) const {
  NodeVectors<Dim> result(body_.grid.mesh.node_count(), Vector<Dim>::Zero());
  for (const int e : elements_) {
    const Eigen::Matrix<double, Dim * Dim, 1> change =
        tangent_[e] * displacement_gradient(displacement, e).reshaped();
    const Gradient stress = change.template reshaped<Eigen::AutoOrder>(Dim, Dim);
    for (int a = 0; a <= Dim; ++a) {
      result[body_.grid.mesh.elements[e][a]] += stress * body_.grid.shape_gradient[e][a];
    }
  }
  for (std::size_t i = 0; i < inertia_.size(); ++i) result[i] += inertia_[i] * displacement[i];
  return result;
}

template <int Dim>
auto Equilibrium<Dim>::mean_moduli(int e) const -> Moduli {
  Moduli sum;
  for (const int p : body_.sorted.of(e)) {
    const double share =
        body_.classes.scale[e] * body_.points.reference_volume[p] / soil_volume_[e];
    sum.lame += share * body_.skeleton[p].parameters.lame();
    sum.shear += share * body_.skeleton[p].parameters.shear_modulus();
  }
  return sum;
}

template <int Dim>
auto Equilibrium<Dim>::elastic_tangent(int e) const -> Tangent {
  const Moduli mean = mean_moduli(e);
  const double lame = soil_volume_[e] * mean.lame;
  const double shear = soil_volume_[e] * mean.shear;
  Tangent tangent = soft_[e] * Tangent::Identity();
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) {
      tangent(i + Dim * i, j + Dim * j) += lame;
      tangent(i + Dim * j, i + Dim * j) += shear;
      tangent(i + Dim * j, j + Dim * i) += shear;
    }
  }
  return tangent;
}

/// The derivative of the forces along the free directions of an element's nodes by the
/// displacements along them; entries of held directions are not used.
template <int Dim>
auto Equilibrium<Dim>::element_matrix(int e, const Tangent& tangent) const -> ElementMatrix {
  const auto& nodes = body_.grid.mesh.elements[e];
  // Maps du along the nodes' directions to grad du, in the order of a matrix's entries.
  Eigen::Matrix<double, Dim * Dim, size> gradient;
  for (int a = 0; a <= Dim; ++a) {
    const auto& directions = unknowns_.supports().directions(nodes[a]);
    for (int k = 0; k < Dim; ++k) {
      const Gradient of_one = directions.col(k) * body_.grid.shape_gradient[e][a].transpose();
      gradient.col(a * Dim + k) = of_one.reshaped();
    }
  }
  return gradient.transpose() * tangent * gradient;
}

template <int Dim>
void Equilibrium<Dim>::make_pattern() {
  const auto unknowns_of = [&](int e) {
    std::array<int, size> list;
    for (int a = 0; a <= Dim; ++a) {
      const int i = body_.grid.mesh.elements[e][a];
      for (int k = 0; k < Dim; ++k) {
        list[a * Dim + k] = k < unknowns_.count(i) ? unknowns_.first(i) + k : -1;
      }
    }
    return list;
  };
  std::vector<Eigen::Triplet<double>> entries;
  for (const int e : elements_) {
    const std::array<int, size> list = unknowns_of(e);
    for (const int column : list) {
      for (const int row : list) {
        if (row >= 0 && column >= 0) entries.emplace_back(row, column, 0.0);
      }
    }
  }
  pattern_.resize(unknowns_.count(), unknowns_.count());
  pattern_.setFromTriplets(entries.begin(), entries.end());
  slots_.resize(elements_.size());
  for (std::size_t at = 0; at < elements_.size(); ++at) {
    const std::array<int, size> list = unknowns_of(elements_[at]);
    for (int column = 0; column < size; ++column) {
      for (int row = 0; row < size; ++row) {
        int& slot = slots_[at][column * size + row];
        slot = -1;
        if (list[row] < 0 || list[column] < 0) continue;
        const int* const rows = pattern_.innerIndexPtr();
        const int* const first = rows + pattern_.outerIndexPtr()[list[column]];
        const int* const last = rows + pattern_.outerIndexPtr()[list[column] + 1];
        slot = static_cast<int>(std::lower_bound(first, last, list[row]) - rows);
      }
    }
  }
}

template <int Dim>
void Equilibrium<Dim>::scatter(const auto& tangent_of, Eigen::SparseMatrix<double>& matrix) const {
  matrix = pattern_;
  double* const values = matrix.valuePtr();
  for (std::size_t at = 0; at < elements_.size(); ++at) {
    const ElementMatrix of_element = element_matrix(elements_[at], tangent_of(elements_[at]));
    for (int k = 0; k < size * size; ++k) {
      if (slots_[at][k] >= 0) values[slots_[at][k]] += of_element.data()[k];
    }
  }
  add_inertia(matrix);
}

template <int Dim>
void Equilibrium<Dim>::add_inertia(Eigen::SparseMatrix<double>& matrix) const {
  for (std::size_t i = 0; i < inertia_.size(); ++i) {
    const auto node = static_cast<int>(i);
    for (int k = 0; k < unknowns_.count(node); ++k) {
      const int unknown = unknowns_.first(node) + k;
      matrix.coeffRef(unknown, unknown) += inertia_[i];
    }
  }
}

template <int Dim>
void Equilibrium<Dim>::assemble(Eigen::SparseMatrix<double>& tangent) const {
  scatter([&](int e) -> const Tangent& { return tangent_[e]; }, tangent);
}

template <int Dim>
void Equilibrium<Dim>::assemble_elastic(Eigen::SparseMatrix<double>& stiffness) const {
  scatter([&](int e) { return elastic_tangent(e); }, stiffness);
}

template class Equilibrium<2>;
template class Equilibrium<3>;

}  // namespace suffuse
