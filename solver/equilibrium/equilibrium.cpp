#include "equilibrium/equilibrium.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "equilibrium/first_tangent.hpp"
#include "equilibrium/sharing_volumes.hpp"
#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Threads pay off from this number of elements on.
constexpr int worth_sharing = 256;

/// A node with a smaller share of the mass that it has inside the soil moves with its element,
/// whose change of the velocity's gradient has inertia then. Otherwise pressures, which act on the
/// whole element, would move it without bounds where a point lies at another node.
constexpr double light_share = 1e-2;

template <int Dim>
Eigen::Matrix<double, Dim, Dim> displacement_gradient(const Grid<Dim>& grid,
                                                      const NodeVectors<Dim>& displacement, int e) {
  Eigen::Matrix<double, Dim, Dim> gradient = Eigen::Matrix<double, Dim, Dim>::Zero();
  for (int a = 0; a <= Dim; ++a) {
    gradient += displacement[grid.mesh.elements[e][a]] * grid.shape_gradient[e][a].transpose();
  }
  return gradient;
}

/// (Jm/J)^(1/d): a factor on F that makes its determinant Jm.
template <int Dim>
double law_factor(double mean_ratio, double ratio) {
  return std::pow(mean_ratio / ratio, 1.0 / Dim);
}

}  // namespace

PointSkeleton skeleton_at(const SkeletonModel& model, double fines_left) {
  if (model.moves()) return {model.law, model.at(fines_left)};
  return {skeleton_law("elastic"), {.young = 1.0}};
}

template <int Dim>
std::vector<int> elements_with_points(const SolidBody<Dim>& body) {
  std::vector<int> result;
  for (int e = 0; e < body.grid.mesh.element_count(); ++e) {
    if (!body.sorted.is_empty(e)) result.push_back(e);
  }
  return result;
}

template <int Dim>
DeformationTangent<Dim> hooke_tangent(double lame, double shear) {
  DeformationTangent<Dim> tangent = DeformationTangent<Dim>::Zero();
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) {
      tangent(i + Dim * i, j + Dim * j) += lame;
      tangent(i + Dim * j, i + Dim * j) += shear;
      tangent(i + Dim * j, j + Dim * i) += shear;
    }
  }
  return tangent;
}

template <int Dim>
Increments<Dim> increments_of(const Grid<Dim>& grid, const NodeVectors<Dim>& displacement) {
  Increments<Dim> result(grid.mesh.element_count(), Eigen::Matrix<double, Dim, Dim>::Identity());
  for (std::size_t e = 0; e < result.size(); ++e) {
    result[e] += displacement_gradient(grid, displacement, static_cast<int>(e));
  }
  return result;
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
  soft_strain_ = soft_;
  moved_.assign(count, Gradient::Zero());
  inverse_.assign(count, Gradient::Identity());
  ratio_.assign(count, 1.0);
  mean_ratio_ = ratio_;
  stress_.assign(count, Gradient::Zero());
  effective_.assign(count, Gradient::Zero());
  soil_volume_ = suffuse::soil_volumes(body.points, body.sorted, body.classes);
  for (const int e : elements_) set_soft_stiffness(e);
  double sum = 0.0;
  for (const int e : elements_) {
    const double modulus = elastic_tangent(e)(0, 0);
    for (const Vector<Dim>& g : body.grid.shape_gradient[e]) sum += (modulus * g).squaredNorm();
  }
  least_force_ = this->least_strain * std::sqrt(sum);
  dilatation_ = SharedDilatation<Dim>(body.grid, sharing_volumes(body, supports, soil_volume_));
  if (!body.weight.empty()) set_weight(body.weight);
}

template <int Dim>
void Equilibrium<Dim>::set_pressure(std::vector<double> pressure, std::vector<double> stiffness) {
  pressure_ = std::move(pressure);
  stiffness_ = std::move(stiffness);
  if (variation_.empty()) return;
  if (pressure_.empty()) pressure_.assign(variation_.size(), 0.0);
  std::vector<double> of_patch = pressure_;
  dilatation_.average(of_patch);
  for (const int e : elements_) {
    const double soil = soil_volume_[e] / body_.grid.volume[e];
    pressure_[e] += soil * (of_patch[e] - pressure_[e] + variation_[e]);
  }
}

template <int Dim>
void Equilibrium<Dim>::set_soft_stiffness(int e) {
  if (body_.classes.full[e] == 1.0) return;
  const auto& points = body_.sorted.of(e);
  double young = 0.0;
  for (const int p : points) young += body_.skeleton[p].parameters.young;
  const double stiffness = (1.0 - body_.classes.full[e]) * body_.grid.volume[e] * young /
                           static_cast<double>(points.size());
  soft_[e] = body_.soft.gradient * stiffness;
  const auto yields = [&](int p) { return body_.skeleton[p].law->yields(); };
  if (body_.soft.strain.empty() || std::ranges::any_of(points, yields)) return;
  double largest = 0.0;
  for (const int i : body_.grid.mesh.elements[e]) largest = std::max(largest, body_.soft.strain[i]);
  soft_strain_[e] = largest * stiffness;
}

template <int Dim>
bool Equilibrium<Dim>::is_possible(const NodeVectors<Dim>& displacement) const {
  for (const int e : elements_) {
    const Gradient f = Gradient::Identity() + displacement_gradient(body_.grid, displacement, e);
    if (!(f.determinant() > min_ratio)) return false;
  }
  return true;
}

template <int Dim>
void Equilibrium<Dim>::for_each_element(const auto& call) const {
  for_each_index(
      static_cast<int>(elements_.size()), threads_, [&](int k) { call(elements_[k]); },
      worth_sharing);
}

template <int Dim>
void Equilibrium<Dim>::displace(const NodeVectors<Dim>& displacement, bool with_tangents) {
  if (displacement == displacement_ && (has_tangents_ || !with_tangents)) return;
  displacement_ = displacement;
  has_tangents_ = with_tangents;
  if (with_tangents) tangent_.resize(body_.grid.mesh.element_count());
  for_each_element([&](int e) {
    moved_[e] = displacement_gradient(body_.grid, displacement, e);
    const Gradient f = Gradient::Identity() + moved_[e];
    ratio_[e] = f.determinant();
    inverse_[e] = f.inverse();
  });
  mean_ratio_ = ratio_;
  dilatation_.average(mean_ratio_);
  for_each_element([&](int e) { respond(with_tangents, e); });
  if (dilatation_.acts()) {
    std::vector<double> mean(ratio_.size(), 0.0);
    for (const int e : elements_) mean[e] = effective_[e].trace() / Dim / mean_ratio_[e];
    const std::vector<double> spread = dilatation_.spread(mean);
    for_each_element([&](int e) {
      if (dilatation_.is_shared(e)) share_stress(spread[e], with_tangents, e);
    });
  }
}

template <int Dim>
Increments<Dim> Equilibrium<Dim>::law_increments(const NodeVectors<Dim>& displacement) const {
  Increments<Dim> result = increments_of(body_.grid, displacement);
  if (!dilatation_.acts()) return result;
  std::vector<double> ratio(result.size());
  for (std::size_t e = 0; e < ratio.size(); ++e) ratio[e] = result[e].determinant();
  std::vector<double> mean = ratio;
  dilatation_.average(mean);
  for (std::size_t e = 0; e < ratio.size(); ++e) {
    if (dilatation_.is_shared(static_cast<int>(e))) {
      result[e] *= law_factor<Dim>(mean[e], ratio[e]);
    }
  }
  return result;
}

/// Sets stress and tangent of an element's laws. Where the element does not share its dilatation,
/// they are also those of its forces.
template <int Dim>
void Equilibrium<Dim>::respond(bool with_tangents, int e) {
  Gradient f = Gradient::Identity() + moved_[e];
  const bool is_shared = dilatation_.is_shared(e);
  if (is_shared) f *= law_factor<Dim>(mean_ratio_[e], ratio_[e]);
  Eigen::Matrix3d kirchhoff = Eigen::Matrix3d::Zero();  // times volume
  Tangent of_stress = Tangent::Zero();
  for (const int p : body_.sorted.of(e)) {
    const auto& [law, parameters] = body_.skeleton[p];
    const double volume = body_.classes.scale[e] * body_.points.reference_volume[p];
    Tangent tangent;
    kirchhoff += volume * skeleton_response<Dim>(*law, parameters, body_.points.skeleton[p], f,
                                                 with_tangents ? &tangent : nullptr)
                              .stress;
    if (with_tangents) of_stress += volume * tangent;
  }
  effective_[e] = kirchhoff.template topLeftCorner<Dim, Dim>();
  stress_[e] = soft_stress(e) + effective_[e] * inverse_[e].transpose();
  if (!with_tangents) return;
  tangent_[e] = is_shared
                    ? of_stress
                    : soft_tangent(e) + first_tangent<Dim>(of_stress, effective_[e], inverse_[e]);
}

/// Let T be the stress of the laws, Fm = (Jm/J)^(1/d) F and g = dF F^-1: dFm Fm^-1 = g + (theta -
/// tr g)/d. The work T : dFm Fm^-1 of all elements is S : g with S = T + (mu - m) I, m = tr T/d and
/// mu = J_e w_e/(sum w) sum m/Jm.
template <int Dim>
void Equilibrium<Dim>::share_stress(double spread, bool with_tangents, int e) {
  const Gradient& stress = effective_[e];
  const double mean = stress.trace() / Dim;
  const double mu = ratio_[e] * spread;
  const Gradient working = stress + (mu - mean) * Gradient::Identity();
  const Gradient to_first = inverse_[e].transpose();
  stress_[e] = soft_stress(e) + working * to_first;
  if (with_tangents) share_tangent(mu, working, e);
  effective_[e] = working;
}

/// Sets the tangent of an element that shares its dilatation, from d tau / d g of its laws. Columns
/// are the derivatives along each component of dF, and by theta.
template <int Dim>
void Equilibrium<Dim>::share_tangent(double mu, const Gradient& working, int e) {
  const Gradient& stress = effective_[e];
  const double mean = stress.trace() / Dim;
  const Gradient to_first = inverse_[e].transpose();
  const Tangent of_law = tangent_[e];
  Gradient by_f;  // of the mean stress
  typename SharedDilatation<Dim>::Tangent shared;
  for (int k = 0; k <= Dim * Dim; ++k) {
    Gradient df = Gradient::Zero();
    if (k < Dim * Dim) df.reshaped()[k] = 1.0;
    const double theta = k < Dim * Dim ? 0.0 : 1.0;
    const Gradient g = df * inverse_[e];
    const Gradient rate = g + (theta - g.trace()) / Dim * Gradient::Identity();
    Gradient of_stress;
    of_stress.reshaped() = of_law * rate.reshaped();
    const double of_mean = of_stress.trace() / Dim;
    const Gradient of_working = of_stress + (mu * g.trace() - of_mean) * Gradient::Identity();
    const Gradient column = (of_working - working * g.transpose()) * to_first;
    if (k < Dim * Dim) {
      tangent_[e].col(k) = column.reshaped();
      by_f.reshaped()[k] = of_mean;
      continue;
    }
    shared.of_both = of_mean - mean;
    for (int a = 0; a <= Dim; ++a) {
      const Vector<Dim>& shape = body_.grid.shape_gradient[e][a];
      shared.of_ratio.col(a) = ratio_[e] * to_first * shape;
      shared.of_mean.col(a) = by_f * shape;
      shared.of_forces.col(a) = column * shape;
    }
  }
  tangent_[e] += soft_tangent(e);
  dilatation_.set_tangent(e, shared);
}

/// The stress of the laws and that of the pore water, - p V_e J F^-T.
template <int Dim>
auto Equilibrium<Dim>::total_stress(int e) const -> Gradient {
  if (pressure_.empty()) return stress_[e];
  return stress_[e] - pressure_at(e) * body_.grid.volume[e] * ratio_[e] * inverse_[e].transpose();
}

/// The part of the pore water has d(J F^-T)_iJ / dF_kL = J (F^-1_Ji F^-1_Lk - F^-1_Jk F^-1_Li).
template <int Dim>
auto Equilibrium<Dim>::total_tangent(int e) const -> Tangent {
  Tangent tangent = tangent_[e];
  if (pressure_.empty()) return tangent;
  const Gradient& inverse = inverse_[e];
  const double stiffness = stiffness_.empty() ? 0.0 : stiffness_[e];
  const double factor = -pressure_at(e) * body_.grid.volume[e] * ratio_[e];
  for (int k = 0; k < Dim; ++k) {
    for (int l = 0; l < Dim; ++l) {
      const Gradient change = inverse.transpose() * inverse(l, k) -
                              inverse.row(l).transpose() * inverse.col(k).transpose();
      tangent.col(k + Dim * l) += factor * change.reshaped();
      if (stiffness == 0.0) continue;
      const double growth = stiffness * ratio_[e] * inverse(l, k);
      tangent.col(k + Dim * l) +=
          growth * body_.grid.volume[e] * ratio_[e] * inverse.transpose().reshaped();
    }
  }
  return tangent;
}

template <int Dim>
NodeVectors<Dim> Equilibrium<Dim>::forces() const {
  NodeVectors<Dim> result(body_.grid.mesh.node_count(), Vector<Dim>::Zero());
  for (const int e : elements_) {
    const Gradient stress = total_stress(e);
    for (int a = 0; a <= Dim; ++a) {
      result[body_.grid.mesh.elements[e][a]] += stress * body_.grid.shape_gradient[e][a];
    }
  }
  for (std::size_t i = 0; i < inertia_.size(); ++i) result[i] += inertia_force(static_cast<int>(i));
  return result;
}

template <int Dim>
void Equilibrium<Dim>::set_inertia(const std::vector<double>& mass,
                                   const NodeVectors<Dim>& velocity, double dt) {
  const double density = std::reduce(mass.begin(), mass.end()) /
                         std::reduce(body_.points.volume.begin(), body_.points.volume.end());
  for (const int e : elements_) {
    const double height = 1.0 / steepest_shape(body_.grid, e);
    double lightest = light_share;
    for (const int i : body_.grid.mesh.elements[e]) {
      const double inside = density * body_.grid.node_volume[i];
      lightest = std::min(lightest, mass[i] / inside);
    }
    soft_[e] =
        (light_share - lightest) * density * body_.grid.volume[e] * height * height / (dt * dt);
  }
  inertia_.resize(mass.size());
  coasting_.resize(mass.size());
  for (std::size_t i = 0; i < mass.size(); ++i) {
    inertia_[i] = mass[i] / (dt * dt);
    coasting_[i] = dt * velocity[i];
  }
  forget_displacement();  // its soft stress has changed
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
    const Gradient stress = total_stress(e);
    for (const Vector<Dim>& g : body_.grid.shape_gradient[e]) sum += (stress * g).squaredNorm();
  }
  return std::sqrt(sum) + least_force_;
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
auto Equilibrium<Dim>::soft_stress(int e) const -> Gradient {
  Gradient held = moved_[e];
  if (has_inertia()) held -= displacement_gradient(body_.grid, coasting_, e);
  return soft_[e] * held + 0.5 * soft_strain_[e] * (moved_[e] + moved_[e].transpose());
}

template <int Dim>
auto Equilibrium<Dim>::soft_tangent(int e) const -> Tangent {
  return soft_[e] * Tangent::Identity() + hooke_tangent<Dim>(0.0, 0.5 * soft_strain_[e]);
}

template <int Dim>
auto Equilibrium<Dim>::elastic_tangent(int e) const -> Tangent {
  const Moduli mean = mean_moduli(e);
  return soft_tangent(e) +
         hooke_tangent<Dim>(soil_volume_[e] * mean.lame, soil_volume_[e] * mean.shear);
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
bool Equilibrium<Dim>::share_pattern(Pattern& pattern) {
  if (pattern_ && pattern == pattern_) return true;
  SoilCouplings couplings{elements_, dilatation_.patch_nodes()};
  const bool fits = pattern && pattern->couplings() == couplings;
  if (!fits) {
    pattern =
        std::make_shared<StiffnessPattern<Dim>>(body_.grid.mesh, unknowns_, std::move(couplings));
  }
  pattern_ = pattern;
  return fits;
}

template <int Dim>
void Equilibrium<Dim>::scatter(const auto& tangent_of, Eigen::SparseMatrix<double>& matrix) {
  if (!pattern_) share_pattern(pattern_);
  matrix = pattern_->zeros();
  double* const values = matrix.valuePtr();
  for (std::size_t at = 0; at < elements_.size(); ++at) {
    const ElementMatrix of_element = element_matrix(elements_[at], tangent_of(elements_[at]));
    const auto& slots = pattern_->of_element(at);
    for (int k = 0; k < size * size; ++k) {
      if (slots[k] >= 0) values[slots[k]] += of_element.data()[k];
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
void Equilibrium<Dim>::assemble(Eigen::SparseMatrix<double>& tangent) {
  scatter([&](int e) { return total_tangent(e); }, tangent);
  dilatation_.add_tangent(unknowns_, mean_ratio_, *pattern_, tangent);
}

template <int Dim>
void Equilibrium<Dim>::assemble_elastic(Eigen::SparseMatrix<double>& stiffness) {
  std::vector<double> shared(ratio_.size(), 0.0);
  scatter(
      [&](int e) {
        Tangent tangent = elastic_tangent(e);
        if (!dilatation_.is_shared(e)) return tangent;
        const Moduli mean = mean_moduli(e);
        shared[e] = soil_volume_[e] * (mean.lame + 2.0 * mean.shear / Dim);
        for (int i = 0; i < Dim; ++i) {
          for (int j = 0; j < Dim; ++j) tangent(i + Dim * i, j + Dim * j) -= shared[e];
        }
        return tangent;
      },
      stiffness);
  dilatation_.add_elastic(body_.grid, unknowns_, shared, *pattern_, stiffness);
}

template std::vector<int> elements_with_points(const SolidBody<2>&);
template std::vector<int> elements_with_points(const SolidBody<3>&);
template DeformationTangent<2> hooke_tangent<2>(double, double);
template DeformationTangent<3> hooke_tangent<3>(double, double);
template Increments<2> increments_of(const Grid<2>&, const NodeVectors<2>&);
template Increments<3> increments_of(const Grid<3>&, const NodeVectors<3>&);
template class Equilibrium<2>;
template class Equilibrium<3>;

}  // namespace suffuse
