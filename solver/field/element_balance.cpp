#include "field/element_balance.hpp"
#include "physics/numbers.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace suffuse {
namespace {

/// Values at vertices from those at field nodes.
template <class Values>
[[gnu::always_inline]] inline Values across_nodes(const Values& values) {
  constexpr int dim = Values::RowsAtCompileTime - 1;
  return (values.array() - FieldNodes<dim>::far_vertex * values.sum()) / FieldNodes<dim>::spread;
}

struct Bracket {
  double low;
  double high;
};

/// Bracket of the sign change of a function that is negative at 0 and positive at 1, within
/// round-off (Illinois, Dowell and Jarratt 1971). The function may jump there.
template <class Function>
Bracket change_of_sign(const Function& function) {
  Bracket at{0.0, 1.0};
  double below = function(at.low);
  double above = function(at.high);
  if (!(below < 0.0)) return {at.low, at.low};
  if (!(above > 0.0)) return {at.high, at.high};
  int side = 0;  // the bound that moved last
  constexpr int enough = 200;
  for (int i = 0; i < enough && at.high - at.low > 1e-15 * at.high; ++i) {
    const double guess = (at.low * above - at.high * below) / (above - below);
    // Bisects every third time, because secants converge slowly at a jump.
    const bool halves = i % 3 == 2 || !(guess > at.low && guess < at.high);
    const double middle = halves ? 0.5 * (at.low + at.high) : guess;
    const double value = function(middle);
    if (value == 0.0) return {middle, middle};
    if (value < 0.0) {
      at.low = middle;
      below = value;
      if (side < 0) above *= 0.5;
      side = -1;
    } else {
      at.high = middle;
      above = value;
      if (side > 0) below *= 0.5;
      side = 1;
    }
  }
  return at;
}

}  // namespace

template <int Dim>
void ElementBalance<Dim>::find_points(const ElementStart<Dim>& start,
                                      const SolidInStep<Dim>& solid) {
  const int e = start.element;
  begin_ = soils_.points_begin(e);
  end_ = soils_.points_begin(e + 1);
  given_ = Values::Zero();
  exchanges_ = false;
  coupled_ = false;
  for (int p = begin_; solid.exchanges && p < end_; ++p) {
    const ExchangeModel& model = soils_.exchange_of_point(p);
    exchanges_ |= model.exchanges();
    coupled_ |= model.exchanges() && model.depends_on_concentration();
  }
  if (!exchanges_) return;
  const auto count = static_cast<std::size_t>(end_ - begin_);
  basis_.resize(count);
  now_.resize(count);
  slope_.assign(count, 0.0);
  guess_.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (int j = 0; j <= Dim; ++j) {
      basis_[i][j] = FieldNodes<Dim>::basis(soils_.points().barycentric[begin_ + i][j]);
    }
  }
  if (coupled_) return;
  for (int p = begin_; p < end_; ++p) {
    now_[p - begin_] = solid.solid.exchange_at(p, solid.solid.porosity()[p], unset, solid.from,
                                               solid.to, solid.flows);
  }
  given_ = spread(now_);
}

template <int Dim>
ElementBalance<Dim>::ElementBalance(const SoilMap<Dim>& soils) : soils_(soils) {
  // Derivatives of `gain` in linear_fines.hpp with respect to the concentration at nodes.
  constexpr double scale = 1.0 / (Dim * (Dim + 1));
  const Matrix identity = Matrix::Identity();
  const Matrix ones = Matrix::Ones();
  const Matrix across = (identity - FieldNodes<Dim>::far_vertex * ones) / FieldNodes<Dim>::spread;
  for (int k = 0; k <= Dim; ++k) {
    Matrix inside = (ones + identity) / (Dim + 2);
    inside.row(k).array() -= 1.0;
    Matrix outside = -(ones + identity);
    outside.row(k).setZero();
    outside.col(k).setZero();
    SideMatrix inflow = SideMatrix::Zero();
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) inflow(side_vertex<Dim>(k, i), j) = i == j ? -2.0 : -1.0;
    }
    by_side_[k] = {scale * across * inside * across, scale * across * (inside + outside) * across,
                   scale * across * inflow};
  }
}

template <int Dim>
void ElementBalance<Dim>::find_moved(const ElementStart<Dim>& start,
                                     const std::vector<double>& first,
                                     const std::vector<double>& last) {
  moved_.setZero();
  first_load_.setZero();
  last_load_.setZero();
  entered_ = 0.0;
  outflow_ = 0.0;
  entering_ = {infinity, -infinity};
  for (int k = 0; k <= Dim; ++k) {
    const double q = start.outflow[k];
    if (q >= 0.0) {
      moved_ += q * by_side_[k].outflow;
      outflow_ += q;
      continue;
    }
    moved_ += q * by_side_[k].inside;
    Eigen::Matrix<double, Dim, 1> at_first;
    Eigen::Matrix<double, Dim, 1> at_last;
    for (int a = 0; a < Dim; ++a) {
      at_first[a] = first[start.upwind[k][a]];
      at_last[a] = last[start.upwind[k][a]];
      entering_.include(at_first[a]);
      entering_.include(at_last[a]);
    }
    // A second-order linear field jumps at sides: the range includes the mean of the upwind
    // element.
    const int upwind = start.neighbour[k];
    if (upwind >= 0) {
      const auto begin = static_cast<std::ptrdiff_t>(Dim + 1) * upwind;
      for (const std::vector<double>* values : {&first, &last}) {
        entering_.include(
            std::accumulate(values->begin() + begin, values->begin() + begin + Dim + 1, 0.0) /
            (Dim + 1));
      }
    }
    first_load_ += q * (by_side_[k].inflow * at_first);
    last_load_ += q * (by_side_[k].inflow * at_last);
    entered_ -= q / Dim * ((1.0 - first_stage) * at_first.sum() + first_stage * at_last.sum());
  }
}

template <int Dim>
bool ElementBalance<Dim>::find_exchange(const SolidInStep<Dim>& solid, bool is_last,
                                        const Values& c) {
  constexpr double little = 1e-6;
  const double dt = solid.to - solid.from;
  const double time = is_last ? solid.end() : solid.first_time();
  for (int p = begin_; p < end_; ++p) {
    const int i = p - begin_;
    const double at_point = std::max(0.0, basis_[i].dot(c));
    // The last stage includes the exchange by the rates of the first stage.
    const double share = (1.0 - first_stage) / first_stage;
    const Exchange before =
        is_last ? Exchange{share * first_[i].eroded, share * first_[i].deposited} : Exchange{};
    const double start = solid.solid.porosity()[p] + before.into_liquid();
    const auto rate = [&](double porosity, double concentration) {
      return solid.solid.exchange_rate_at(p, porosity, concentration, time, solid.flows);
    };
    const auto net = [&](double porosity, double concentration) {
      return first_stage * dt * rate(porosity, concentration).into_liquid();
    };
    // Solves n = start + net(n, c) by Newton's method.
    double n = is_last ? start : start + guess_[i];
    double by_porosity = 0.0;
    bool solved = false;
    for (int iteration = 0; iteration < 20 && !solved; ++iteration) {
      const double there = net(n, at_point);
      by_porosity = (net(n - little, at_point) - there) / -little;
      const double change = (start + there - n) / (1.0 - by_porosity);
      n += change;
      solved = std::abs(change) <= 1e-15;
      if (!std::isfinite(n)) return false;
    }
    if (!solved || !solid.solid.is_possible(p, n, time, solid.flows)) return false;
    const Exchange now = rate(n, at_point);
    const double by_concentration =
        (net(n, at_point + little) - first_stage * dt * now.into_liquid()) / little;
    slope_[i] = by_concentration / (1.0 - by_porosity);
    now_[i] = {before.eroded + first_stage * dt * now.eroded,
               before.deposited + first_stage * dt * now.deposited};
    if (!is_last) guess_[i] = now_[i].into_liquid();
  }
  return true;
}

template <int Dim>
auto ElementBalance<Dim>::spread(const std::vector<Exchange>& exchange) const -> Values {
  Values result = Values::Zero();
  for (int p = begin_; p < end_; ++p) {
    result += soils_.points().volume[p] * exchange[p - begin_].into_liquid() * basis_[p - begin_];
  }
  return result;
}

template <int Dim>
bool ElementBalance<Dim>::solve_stage(const SolidInStep<Dim>& solid, const Stage& stage,
                                      bool is_last, Values& c) {
  constexpr int enough = 30;
  for (int iteration = 0; iteration < enough; ++iteration) {
    if (coupled_) {
      if (!find_exchange(solid, is_last, c)) return false;
      given_ = spread(now_);
    }
    // If the exchange is known in advance, the first stage takes its share of it.
    const Values given = (coupled_ || is_last ? 1.0 : first_stage) * given_;
    Matrix system = -first_stage * moved_;
    system.diagonal() += stage.liquid + given;
    if (!coupled_) {
      c = system.inverse() * (stage.known + given);
      return true;
    }
    Matrix by_concentration = Matrix::Zero();
    for (int p = begin_; p < end_; ++p) {
      const Values& basis = basis_[p - begin_];
      by_concentration +=
          soils_.points().volume[p] * slope_[p - begin_] * basis * basis.transpose();
    }
    const Values residual = system * c - stage.known - given;
    system += (c.array() - 1.0).matrix().asDiagonal() * by_concentration;
    const Values change = system.inverse() * residual;
    c -= change;
    const double size = change.template lpNorm<Eigen::Infinity>();
    if (size <= 1e-18 + 1e-13 * c.template lpNorm<Eigen::Infinity>()) return true;
    if (!std::isfinite(size)) return false;
  }
  return false;
}

template <int Dim>
bool ElementBalance<Dim>::solve_linear(const ElementStart<Dim>& start,
                                       const SolidInStep<Dim>& solid, StepErrors& errors) {
  const Values fines = Eigen::Map<const Values>(start.fines.data());
  const Values liquid = Eigen::Map<const Values>(start.liquid.data());
  const double growth = start.gained / liquid.sum();

  Values c = fines.cwiseQuotient(liquid);
  Stage stage{(1.0 + first_stage * growth) * liquid, fines + first_stage * first_load_};
  if (!solve_stage(solid, stage, false, c)) return false;
  const Values c_first = c;
  first_ = now_;
  const Values moved_first = moved_ * c_first + first_load_;
  const double given_first = (coupled_ ? 1.0 : first_stage) * given_.sum();

  stage = {(1.0 + growth) * liquid,
           fines + (1.0 - first_stage) * moved_first + first_stage * last_load_};
  if (!solve_stage(solid, stage, true, c)) return false;
  const Values moved_last = moved_ * c + last_load_;
  const double given_last = given_.sum();

  Eigen::Map<Values>(at_vertices_.first.data()) = across_nodes(c_first);
  Eigen::Map<Values>(at_vertices_.last.data()) = across_nodes(c);
  // The errors are deviations of the first stage from a straight line between the ends.
  const double change_first = first_stage * moved_first.sum() + given_first;
  const double change_last =
      (1.0 - first_stage) * moved_first.sum() + first_stage * moved_last.sum() + given_last;
  errors.fines = std::abs(change_last - change_first / first_stage);
  if (coupled_) errors.exchange = std::abs(given_last - given_first / first_stage);
  errors.held = std::abs(fines.sum() + change_last);
  errors.exchanged = std::abs(given_last);
  return true;
}

template <int Dim>
double ElementBalance<Dim>::solve_mean(const ElementStart<Dim>& start,
                                       const SolidInStep<Dim>& solid) {
  const double fines = element_sum<Dim>(start.fines);
  const double liquid = element_sum<Dim>(start.liquid) + start.gained;
  const std::vector<double>& porosity = solid.solid.porosity();
  const auto given = [&](double mean) {
    for (int p = begin_; p < end_; ++p) {
      now_[p - begin_] =
          solid.solid.exchange_at(p, porosity[p], mean, solid.from, solid.to, solid.flows);
    }
    return spread(now_).sum();
  };
  const auto balance = [&](double s) { return (fines + entered_ + s) / (liquid + s + outflow_); };
  if (!coupled_) return balance(given_.sum());
  const auto missing = [&](double m, double s) {
    const double result = (liquid + s + outflow_) * m - fines - entered_ - s;
    // If the grains lock, the exchange is not finite: m is too large.
    return std::isfinite(result) ? result : liquid + outflow_;
  };
  const Bracket mean = change_of_sign([&](double m) { return missing(m, given(m)); });
  const double below = missing(mean.low, given(mean.low));
  const std::vector<Exchange> at_low = now_;
  const double above = missing(mean.high, given(mean.high));
  // The exchange may jump between the bounds; interpolation gives the balance.
  const double share = above > below ? std::clamp(-below / (above - below), 0.0, 1.0) : 0.0;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    now_[i].eroded = std::lerp(at_low[i].eroded, now_[i].eroded, share);
    now_[i].deposited = std::lerp(at_low[i].deposited, now_[i].deposited, share);
  }
  return std::lerp(mean.low, mean.high, share);
}

template <int Dim>
auto ElementBalance<Dim>::allowed(const ElementStart<Dim>& start) const -> Range {
  Range range = entering_;
  ElementValues<Dim> before;
  for (int j = 0; j <= Dim; ++j) before[j] = start.fines[j] / start.liquid[j];
  for (const double c : FieldNodes<Dim>::at_vertices(before)) range.include(c);
  if (exchanges_) {
    // A path through a corner is up to Dim times as long as the mean path.
    double eroded = 0.0;
    double deposited = 0.0;
    for (int p = begin_; p < end_; ++p) {
      eroded += soils_.points().volume[p] * now_[p - begin_].eroded;
      deposited += soils_.points().volume[p] * now_[p - begin_].deposited;
    }
    const double passing = element_sum<Dim>(start.liquid) + outflow_;
    range.high += Dim * eroded / passing;
    range.low -= Dim * deposited / passing;
  }
  // In a flat field round-off alone would leave the range.
  const double slack = 1e-13 * range.high;
  return {std::max(0.0, range.low - slack), std::min(1.0, range.high + slack)};
}

template <int Dim>
bool ElementBalance<Dim>::is_within(const Range& range) const {
  bool within = true;
  for (int k = 0; k <= Dim; ++k) {
    within &= range.includes(at_vertices_.first[k]) && range.includes(at_vertices_.last[k]);
  }
  return within;
}

template <int Dim>
double ElementBalance<Dim>::slope_within(const Range& range, double mean) const {
  double slope = 1.0;
  for (const ElementValues<Dim>& values : {at_vertices_.first, at_vertices_.last}) {
    for (const double value : values) {
      if (range.includes(value)) continue;
      const double room = value > mean ? range.high - mean : mean - range.low;
      slope = std::min(slope, std::clamp(room / std::abs(value - mean), 0.0, 1.0));
    }
  }
  return slope;
}

template <int Dim>
StepErrors ElementBalance<Dim>::solve(const ElementStart<Dim>& start, const SolidInStep<Dim>& solid,
                                      double& slope, std::vector<double>& first,
                                      std::vector<double>& last, std::vector<Exchange>& exchange) {
  StepErrors errors;
  find_points(start, solid);
  find_moved(start, first, last);
  const bool solved = solve_linear(start, solid, errors);
  if (!solved) slope = 0.0;

  double mean = 0.0;
  linear_ = now_;
  if (slope < 1.0 || !is_within(allowed(start))) {
    mean = solve_mean(start, solid);
    if (slope > 0.0) slope = std::min(slope, slope_within(allowed(start), mean));
  }
  if (!solved) {
    // Reference values of the errors; there is no error estimate.
    const double given = spread(now_).sum();
    errors = {.held = mean * (element_sum<Dim>(start.liquid) + start.gained + given),
              .exchanged = std::abs(given)};
  }
  // Both solutions satisfy the balance, and so does every mean of them.
  const auto between = [&](double at_mean, double linear) {
    return slope == 1.0 ? linear : slope == 0.0 ? at_mean : at_mean + slope * (linear - at_mean);
  };
  const std::size_t place = (Dim + 1) * static_cast<std::size_t>(start.element);
  for (int k = 0; k <= Dim; ++k) {
    first[place + k] = between(mean, at_vertices_.first[k]);
    last[place + k] = between(mean, at_vertices_.last[k]);
  }
  for (int p = begin_; p < end_ && exchanges_; ++p) {
    const Exchange& at_mean = now_[p - begin_];
    const Exchange& linear = linear_[p - begin_];
    exchange[p] = {between(at_mean.eroded, linear.eroded),
                   between(at_mean.deposited, linear.deposited)};
  }
  return errors;
}

template class ElementBalance<2>;
template class ElementBalance<3>;

}  // namespace suffuse
