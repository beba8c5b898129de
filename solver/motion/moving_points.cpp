/// The points of a moving skeleton: their order, and their fields in results.

#include <algorithm>
#include <array>
#include <cmath>

#include "boundary/loads.hpp"
#include "grid/parallel.hpp"
#include "motion/compressed_soil.hpp"
#include "motion/element_stiffness.hpp"
#include "motion/moving_skeleton.hpp"

namespace suffuse {
namespace {

/// Data of points for a snapshot.
template <int Dim>
struct ShownPoints {
  const SolidPoints<Dim>& points;
  const std::vector<Vector<Dim>>& start;  ///< m
  const std::vector<int>& id;
  std::vector<Eigen::Matrix3d> stress;  ///< Pa
  std::vector<double> fines_left;
  std::string_view internal;  ///< name of the laws' internal variable; may be empty
};

/// Name of the internal variable of the scene's laws; empty if they have none.
std::string_view internal_of(const Scene& scene) {
  for (const Soil& soil : scene.soils) {
    if (soil.skeleton.moves() && !soil.skeleton.law->internal.empty()) {
      return soil.skeleton.law->internal;
    }
  }
  return {};
}

template <int Dim>
void show(const ShownPoints<Dim>& shown, Snapshot& snapshot) {
  const SolidPoints<Dim>& points = shown.points;
  Field displacement{"displacement", "m", Dim, {}};
  Field stress{"effective_stress", "Pa", Dim == 2 ? 4 : 6, {}};
  Field plastic{"plastic_strain", "1", 1, points.plastic_strain};
  Field fines{"fines_left", "1", 1, shown.fines_left};
  Field volume{"volume", Dim == 2 ? "m3/m" : "m3", 1, points.volume};
  Field element{"element", "1", 1, {points.element.begin(), points.element.end()}, true};
  Field id{"id", "1", 1, {shown.id.begin(), shown.id.end()}, true};
  const auto add = [](std::vector<double>& values, const auto& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  for (int p = 0; p < points.size(); ++p) {
    add(displacement.values, Vector<Dim>(points.position[p] - shown.start[p]));
    const Eigen::Matrix3d& s = shown.stress[p];
    add(stress.values, std::array{s(0, 0), s(1, 1), s(2, 2), s(0, 1)});
    if (Dim == 3) add(stress.values, std::array{s(1, 2), s(0, 2)});
    for (int d = 0; d < 3; ++d) {
      snapshot.solid_positions.push_back(d < Dim ? points.position[p][d] : 0.0);
    }
  }
  for (Field* field : {&displacement, &stress, &plastic, &fines, &volume, &element, &id}) {
    snapshot.solid.push_back(std::move(*field));
  }
  if (shown.internal.empty()) return;
  Field internal{std::string(shown.internal), "1", 1, {}};
  for (const SkeletonState& state : points.skeleton) internal.values.push_back(state.internal);
  snapshot.solid.push_back(std::move(internal));
}

template <int Dim>
void add_displacements(const std::vector<Vector<Dim>>& start, const std::vector<Vector<Dim>>& now,
                       const Vector<Dim>& down, HistoryRow& row) {
  for (std::size_t p = 0; p < now.size(); ++p) {
    const Vector<Dim> displacement = now[p] - start[p];
    row.settlement_max = std::max(row.settlement_max, displacement.dot(down));
    row.displacement_max = std::max(row.displacement_max, displacement.norm());
  }
}

}  // namespace

template <int Dim>
void MovingSkeleton<Dim>::sort_points(double time) {
  refuse_impossible(this->grid_, solid_, time);
  if (!std::ranges::is_sorted(points_.element)) {
    const PointsByElement sorted(this->grid_.mesh.element_count(), points_.element);
    std::vector<int> order;
    order.reserve(points_.size());
    for (int e = 0; e < this->grid_.mesh.element_count(); ++e) {
      order.insert(order.end(), sorted.of(e).begin(), sorted.of(e).end());
    }
    const auto all = [&](auto&... values) { (reorder(order, values), ...); };
    points_.reorder(order);
    all(this->state_.skeleton_volume, this->state_.erodible_volume, this->state_.deposited_volume,
        this->initial_porosity_, start_, id_, region_, initial_erodible_);
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
  const std::vector<double> solid = this->state_.solid_volumes();
  const auto sums = [this](const std::vector<double>& of_points) {
    return sums_in_elements(this->grid_, points_, of_points, 1.0);
  };
  // Volumes at the surface are smoothed by nodes: the drag would otherwise jump when points leave
  // an element.
  filling_ = soil_filling(classes, SoilVolumes{sums(points_.volume), sums(solid)},
                          SoilVolumes{smooth(points_.volume), smooth(solid)}, element_porosity());
}

// ---------------------------------------------------------------------------------------- results

template <int Dim>
void MovingSkeleton<Dim>::describe(HistoryRow& row) const {
  add_displacements<Dim>(start_, points_.position, downwards<Dim>(movable_soils_.scene().gravity),
                         row);
  row.solid_correction = correction_;
  row.inertia = inertia_.share();
  row.newton_iterations = static_cast<double>(newton_iterations_);
}

template <int Dim>
void MovingSkeleton<Dim>::describe(Snapshot& snapshot) const {
  ShownPoints<Dim> shown{points_, start_, id_, {}, {}, internal_of(movable_soils_.scene())};
  for (int p = 0; p < points_.size(); ++p) {
    shown.stress.push_back(effective_stress(p));
    shown.fines_left.push_back(fines_left(p));
  }
  show(shown, snapshot);
}

template class MovingSkeleton<2>;
template class MovingSkeleton<3>;

}  // namespace suffuse
