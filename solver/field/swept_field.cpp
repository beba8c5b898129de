#include "field/swept_field.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "field/linear_fines.hpp"
#include "grid/parallel.hpp"
#include "grid/shared_sweep_order.hpp"
#include "linear/anderson_mixing.hpp"
#include "physics/numbers.hpp"
#include "solid/rank_state.hpp"

namespace suffuse {
namespace {

/// Fines distributed like the solved concentration, with the total `sum`, m3. `sum` is a
/// difference: if it is negative within the round-off of the `passing` liquid, m3, it is ignored.
template <int Dim>
ElementValues<Dim> fines_of(const ElementValues<Dim>& liquid, const double* at_vertices, double sum,
                            double passing) {
  constexpr double round_off = 1e-13;
  double all = 0.0;
  for (int k = 0; k <= Dim; ++k) all += at_vertices[k];
  ElementValues<Dim> result;
  double solved = 0.0;
  for (int j = 0; j <= Dim; ++j) {
    const double c = FieldNodes<Dim>::far_vertex * all + FieldNodes<Dim>::spread * at_vertices[j];
    solved += result[j] = liquid[j] * c;
  }
  if (sum <= 0.0 && sum >= -round_off * passing) return result;
  if (!(solved > 0.0)) {
    const double mean = sum / element_sum<Dim>(liquid);
    for (int j = 0; j <= Dim; ++j) result[j] = liquid[j] * mean;
    return result;
  }
  for (double& fines : result) fines *= sum / solved;
  return result;
}

/// The scalar product of vectors of which each rank has a part, with `block` values per element:
/// the same bits for any order of the elements, and on any number of ranks.
template <int block>
double exact_dot(const Ranks& ranks, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  ExactSum sum;
  for (Eigen::Index i = 0; i < a.size(); i += block) {
    double of_element = 0.0;
    for (Eigen::Index k = i; k < i + block; ++k) of_element += a[k] * b[k];
    sum.add(of_element);
  }
  ranks.sum({&sum});
  return sum.value();
}

/// NaN counts as infinite.
double largest_entry(const Eigen::VectorXd& values) {
  if (values.size() == 0) return 0.0;
  return values.allFinite() ? values.lpNorm<Eigen::Infinity>() : infinity;
}

}  // namespace

template <int Dim>
SweptField<Dim>::SweptField(const Grid<Dim>& grid, const ElementSides<Dim>& sides,
                            const SoilMap<Dim>& soils, const BoundaryValues<Dim>& boundary_values,
                            int threads)
    : grid_(grid),
      sides_(sides),
      soils_(soils),
      boundary_values_(boundary_values),
      conditions_(boundary_values.at(0.0)),
      threads_(threads),
      balance_(soils),
      points_(point_rows(grid, soils)) {}

template <int Dim>
void SweptField<Dim>::start(const std::vector<double>& face_volume, std::vector<double> gained) {
  const int elements = grid_.mesh.element_count();
  const ElementField<Dim> before = std::move(outflow_);
  outflow_.resize(elements);
  upwind_.resize(elements);
  fines_out_.assign(elements, ElementValues<Dim>{});
  first_.resize(sides_.value_count());
  last_.resize(sides_.value_count());
  gained_ = std::move(gained);
  for_each_index(elements, threads_, [&](int e) {
    outflow_[e] = sides_.outflow(e, face_volume);
    upwind_[e] = sides_.upwind_places(e, outflow_[e]);
  });
  inflow_.clear();
  for (const int f : sides_.outer_faces()) {
    inflow_.push_back(grid_.owns_face(f) ? std::max(0.0, -face_volume[f]) : 0.0);
  }
  const auto turned = [&](int e) {
    for (int k = 0; k <= Dim; ++k) {
      if ((before[e][k] < 0.0) != (outflow_[e][k] < 0.0)) return 1.0;
    }
    return 0.0;
  };
  const bool same = !before.empty() && largest_of(elements, threads_, 0.0, turned) == 0.0;
  if (any_of_all(grid_.ranks(), !same)) find_order();
}

template <int Dim>
void SweptField<Dim>::find_order() {
  ElementsAcross<Dim> upwind(outflow_.size());
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    for (int k = 0; k <= Dim; ++k) {
      const int other = sides_.of(e).neighbour[k];
      upwind[e][k] = other >= 0 && outflow_[e][k] < 0.0 ? other : -1;
    }
  }
  order_ = grid_.ranks().count() > 1 ? shared_sweep_order(grid_, upwind) : sweep_order<Dim>(upwind);
}

template <int Dim>
StepErrors SweptField<Dim>::solve_element(const FinesState<Dim>& state,
                                          const SolidInStep<Dim>& solid, double share, int element,
                                          double& slope) {
  ElementStart<Dim> start{.element = element,
                          .liquid = state.liquid_volume[element],
                          .fines = state.fines_volume[element],
                          .gained = gained_.empty() ? 0.0 : share * gained_[element],
                          .outflow = outflow_[element],
                          .upwind = upwind_[element],
                          .neighbour = sides_.of(element).neighbour};
  for (double& q : start.outflow) q *= share;
  return balance_.solve(start, solid, slope, first_, last_, exchange_);
}

template <int Dim>
void SweptField<Dim>::set_entering(double time, std::vector<double>& at_vertices) {
  boundary_values_.update_concentrations(time, conditions_);
  sides_.set_entering(conditions_, at_vertices);
}

template <int Dim>
bool SweptField<Dim>::solve(const FinesState<Dim>& state, const SolidInStep<Dim>& solid,
                            double share, StepErrors& errors) {
  share_ = share;
  StepErrorSums sums;
  exchange_.assign(soils_.points().size(), Exchange{});
  set_entering(solid.first_time(), first_);
  set_entering(solid.end(), last_);
  sums.entered.add(share * std::inner_product(inflow_.begin(), inflow_.end(),
                                              last_.end() - inflow_.size(), 0.0));
  bool solved = true;
  for (const SweepOrder::Part& part : order_.parts) {
    if (part.is_circle) {
      solved = solve_circle(state, solid, share, part, sums) && solved;
    } else {
      for (int i = part.begin; i < part.end; ++i) {
        double slope = 1.0;
        sums.add(solve_element(state, solid, share, order_.elements[i], slope));
      }
    }
    if (part.sends) send_values();
  }
  points_.exchange(exchange_);
  errors = sums.of_all(grid_.ranks());
  return !any_of_all(grid_.ranks(), !solved);
}

template <int Dim>
bool SweptField<Dim>::solve_circle(const FinesState<Dim>& state, const SolidInStep<Dim>& solid,
                                   double share, const SweepOrder::Part& circle,
                                   StepErrorSums& errors) {
  // Repeats passes along the flow, each from the values of the one before. After a few passes
  // limits may only become stricter, so that the iteration converges.
  constexpr int enough = 200;
  constexpr int free_passes = 4;
  constexpr int remembered = 12;
  constexpr double round_off = 1e-14;
  constexpr int vertices = Dim + 1;
  const int count = circle.end - circle.begin;
  const bool is_shared = !circle.rounds.empty();
  const Ranks& ranks = is_shared ? grid_.ranks() : alone_;
  const std::vector<int> rounds = is_shared ? circle.rounds : std::vector<int>{circle.end};
  const auto for_values = [&](const auto& take) {
    Eigen::Index at = 0;
    for (int i = circle.begin; i < circle.end; ++i) {
      const std::size_t place = vertices * static_cast<std::size_t>(order_.elements[i]);
      for (int k = 0; k < vertices; ++k, at += 2) {
        take(at, first_[place + k]);
        take(at + 1, last_[place + k]);
      }
    }
  };
  Eigen::VectorXd before(2 * vertices * count);
  Eigen::VectorXd after(before.size());
  for (int i = circle.begin; i < circle.end; ++i) {
    const std::size_t e = order_.elements[i];
    find_concentration<Dim>(state.fines_volume[e], state.liquid_volume[e], &first_[vertices * e]);
    std::copy_n(&first_[vertices * e], vertices, &last_[vertices * e]);
  }
  if (is_shared) send_values();
  std::vector<double> slopes(count, 1.0);
  AndersonMixing mixing(remembered, [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return exact_dot<2 * vertices>(ranks, a, b);
  });
  for (int pass = 0; pass < enough; ++pass) {
    StepErrorSums of_pass;
    for_values([&](Eigen::Index at, const double& value) { before[at] = value; });
    int i = circle.begin;
    for (const int end : rounds) {
      for (; i < end; ++i) {
        double& slope = slopes[i - circle.begin];
        if (pass < free_passes) slope = 1.0;
        of_pass.add(solve_element(state, solid, share, order_.elements[i], slope));
      }
      if (is_shared) send_values();
    }
    for_values([&](Eigen::Index at, const double& value) { after[at] = value; });
    const double change = largest_of_all(ranks, largest_entry(after - before));
    if (change <= round_off * largest_of_all(ranks, largest_entry(after))) {
      errors.add(of_pass);
      return true;
    }
    if (!std::isfinite(change)) return false;
    if (pass < free_passes) continue;
    const Eigen::VectorXd next = mixing.next(before, after);
    for_values([&](Eigen::Index at, double& value) { value = next[at]; });
    if (is_shared) send_values();
  }
  return false;
}

template <int Dim>
void SweptField<Dim>::finish(FinesState<Dim>& state, const ElementField<Dim>& received) {
  // The flux through a side is the mean over the step, equal for both elements.
  for (std::size_t i = 0; i < last_.size(); ++i) {
    first_[i] = (1.0 - first_stage) * first_[i] + first_stage * last_[i];
  }
  const int elements = grid_.mesh.element_count();
  for_each_index(elements, threads_, [&](int e) {
    ElementValues<Dim>& liquid = state.liquid_volume[e];
    ElementValues<Dim>& fines = state.fines_volume[e];
    const std::size_t place = (Dim + 1) * static_cast<std::size_t>(e);
    double sum = element_sum<Dim>(fines);
    double passing = element_sum<Dim>(liquid);
    ElementValues<Dim> outflow = outflow_[e];
    for (double& q : outflow) {
      q *= share_;
      passing += std::abs(q);
    }
    const ElementValues<Dim> moved =
        gain<Dim>(&first_[place], outflow, first_, upwind_[e], 1.0, fines_out_[e]);
    if (!gained_.empty()) add_liquid<Dim>(liquid, share_ * gained_[e]);
    for (int j = 0; j <= Dim; ++j) liquid[j] += received[e][j];
    sum += element_sum<Dim>(received[e]) + element_sum<Dim>(moved);
    fines = fines_of<Dim>(liquid, &last_[place], sum, passing);
  });
  // Concentrations beyond the fringe are not known here.
  grid_.element_rows().exchange(state.fines_volume);
  const auto mean = [&](int e) {
    return element_sum<Dim>(state.fines_volume[e]) / element_sum<Dim>(state.liquid_volume[e]);
  };
  refuse_impossible_concentrations(grid_, mean, threads_);
}

template <int Dim>
void SweptField<Dim>::fines_crossed(std::vector<double>& result) const {
  sides_.at_faces(fines_out_, threads_, result);
}

template class SweptField<2>;
template class SweptField<3>;

}  // namespace suffuse
