#pragma once

/// Critical head of backward erosion: the rule of Sellmeijer, Lopez de la Cruz, van Beek and Knoeff
/// (2011), fine-tuned by small, medium and large tests.

#include <string>
#include <vector>

namespace suffuse {

/// A layer of sand below a roof, from the entry of the water to the exit of the pipe.
struct PipingLayer {
  double length = 0.0;             ///< L, m
  double thickness = 0.0;          ///< D, m
  double d70 = 0.0;                ///< m
  double permeability = 0.0;       ///< kappa, intrinsic, m2
  double relative_weight = 1.65;   ///< G_s - 1
  double uniformity = 1.81;        ///< U = d60/d10
  double roundness = 49.8;         ///< KAS, per cent
  double relative_density = 72.5;  ///< RD, per cent
  bool grain_size_correction = true;
};

/// H_c = L F_R F_S F_G, m: the pipe grows through to the entry where the difference of head from
/// entry to exit is larger.
double critical_head(const PipingLayer& layer);

/// What lies outside the range of the tests, as sentences: "d70 = 0.1 mm; tests had 0.15 to 0.43
/// mm".
std::vector<std::string> outside_tests(const PipingLayer& layer);

}  // namespace suffuse
