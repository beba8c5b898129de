#include "physics/skeleton/skeleton_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace suffuse {

const SkeletonLaw* skeleton_law(std::string_view word) {
  for (const SkeletonLaw* law : skeleton_laws()) {
    if (law->word == word) return law;
  }
  throw std::invalid_argument("no skeleton law '" + std::string(word) + "'");
}

bool SkeletonLaw::has_strength() const {
  return std::ranges::count(parameters, &SkeletonModel::cohesion, &SkeletonParameter::value) > 0;
}

FinesFunction::FinesFunction(std::vector<std::pair<double, double>> all) : pairs(std::move(all)) {
  if (pairs.front().first > pairs.back().first) std::ranges::reverse(pairs);
}

double FinesFunction::value(double fines_left) const {
  if (pairs.size() == 1) return pairs.front().second;
  const auto after =
      std::ranges::upper_bound(pairs, fines_left, {}, [](const auto& pair) { return pair.first; });
  if (after == pairs.begin()) return pairs.front().second;
  if (after == pairs.end()) return pairs.back().second;
  const auto before = after - 1;
  return std::lerp(before->second, after->second,
                   (fines_left - before->first) / (after->first - before->first));
}

double FinesFunction::smallest() const {
  return std::ranges::min(pairs, {}, [](const auto& pair) { return pair.second; }).second;
}

SkeletonParameters SkeletonModel::at(double fines_left) const {
  constexpr double radians = std::numbers::pi / 180.0;  // of one degree
  return {.young = young.value(fines_left),
          .poisson = poisson.value(fines_left),
          .friction = friction.value(fines_left) * radians,
          .cohesion = cohesion.value(fines_left),
          .dilation = dilation.value(fines_left) * radians,
          .compression = compression.value(fines_left),
          .preconsolidation = preconsolidation.value(fines_left)};
}

}  // namespace suffuse
