/// The points of a skeleton that moves: their order, and what results show of them.

#include <algorithm>
#include <array>
#include <cmath>

#include "equilibrium/compressed_soil.hpp"
#include "equilibrium/loads.hpp"
#include "grid/parallel.hpp"
#include "motion/moving_skeleton.hpp"

namespace suffuse {

template <int Dim>
void MovingSkeleton<Dim>::check_pores(const MotionStep<Dim>& step) const {
  refuse_compressed<Dim>(this->grid_, this->soils(),
                         {points_, solid_volumes(), this->initial_porosity_,
                          step.equilibrium->displacement(), step.forcing.end});
}

template <int Dim>
void MovingSkeleton<Dim>::sort_points(double time) {
  refuse_filled(this->grid_, solid_, time);
  if (!std::ranges::is_sorted(points_.element)) {
    const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
    std::vector<int> order;
    order.reserve(points_.size());
    for (int e = 0; e < this->grid_.mesh.element_count(); ++e) {
      order.insert(order.end(), sorted.of(e).begin(), sorted.of(e).end());
    }
    const auto all = [&](auto&... values) { (reorder(order, values), ...); };
    all(start_, points_.position, points_.element, points_.reference_volume, points_.volume,
        points_.elastic_b, points_.plastic_strain, this->state_.skeleton_volume,
        this->state_.erodible_volume, this->state_.deposited_volume, this->initial_porosity_, id_,
        region_, initial_erodible_);
    inertia_.reorder(order);
  }
  show_points();
  find_filling();
}

template <int Dim>
void MovingSkeleton<Dim>::show_points() {
  MaterialPoints<Dim> shown{points_.element, {}, points_.volume};
  shown.barycentric.resize(points_.size());
  for_each_index(points_.size(), this->threads_, [&](int p) {
    shown.barycentric[p] = barycentric(this->grid_.mesh, points_.element[p], points_.position[p]);
  });
  movable_soils_.move_points(std::move(shown), region_);
  this->porosity_max_.resize(points_.size());
  for (int p = 0; p < points_.size(); ++p) {
    this->porosity_max_[p] = 1.0 - this->state_.skeleton_volume[p] / points_.volume[p];
  }
  this->update_porosity();
}

template <int Dim>
void MovingSkeleton<Dim>::find_filling() {
  const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
  const ElementClasses classes(this->grid_, points_, sorted);
  // Carried to nodes and back: the points in an element would make the drag jump as they leave it.
  const std::vector<double> volume = smooth(points_.volume);
  const std::vector<double> solid = smooth(solid_volumes());
  filling_.assign(solid_.size(), {});
  for (std::size_t e = 0; e < solid_.size(); ++e) {
    if (classes.full[e] == 1.0) continue;
    const double share = std::min(1.0, volume[e] / this->grid_.volume[e]);
    filling_[e] = {std::lerp(share, 1.0, classes.full[e]),
                   volume[e] > 0.0 ? 1.0 - solid[e] / volume[e] : 1.0};
  }
}

// ---------------------------------------------------------------------------------------- results

template <int Dim>
void MovingSkeleton<Dim>::describe(HistoryRow& row) const {
  const Scene& scene = movable_soils_.scene();
  const Vector<Dim> down = downwards<Dim>(scene.gravity);
  for (int p = 0; p < points_.size(); ++p) {
    const Vector<Dim> displacement = points_.position[p] - start_[p];
    row.settlement_max = std::max(row.settlement_max, displacement.dot(down));
    row.displacement_max = std::max(row.displacement_max, displacement.norm());
  }
  row.solid_correction = correction_;
  row.inertia = inertia_.share();
  row.newton_iterations = static_cast<double>(newton_iterations_);
}

template <int Dim>
void MovingSkeleton<Dim>::describe(Snapshot& snapshot) const {
  Field displacement{"displacement", "m", Dim, {}};
  Field stress{"effective_stress", "Pa", Dim == 2 ? 4 : 6, {}};
  Field plastic{"plastic_strain", "1", 1, points_.plastic_strain};
  Field fines{"fines_left", "1", 1, {}};
  Field volume{"volume", Dim == 2 ? "m3/m" : "m3", 1, points_.volume};
  Field element{"element", "1", 1, {points_.element.begin(), points_.element.end()}, true};
  Field id{"id", "1", 1, {id_.begin(), id_.end()}, true};
  const auto add = [](std::vector<double>& values, const auto& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  for (int p = 0; p < points_.size(); ++p) {
    add(displacement.values, Vector<Dim>(points_.position[p] - start_[p]));
    const Eigen::Matrix3d s = effective_stress(p);
    add(stress.values, std::array{s(0, 0), s(1, 1), s(2, 2), s(0, 1)});
    if (Dim == 3) add(stress.values, std::array{s(1, 2), s(0, 2)});
    fines.values.push_back(fines_left(p));
    for (int d = 0; d < 3; ++d) {
      snapshot.solid_positions.push_back(d < Dim ? points_.position[p][d] : 0.0);
    }
  }
  for (Field* field : {&displacement, &stress, &plastic, &fines, &volume, &element, &id}) {
    snapshot.solid.push_back(std::move(*field));
  }
}

template class MovingSkeleton<2>;
template class MovingSkeleton<3>;

}  // namespace suffuse
