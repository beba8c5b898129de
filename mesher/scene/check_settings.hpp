#pragma once

/// Settings of the checks of standards that `suffuse-post check` makes of a run. They change no
/// result.

#include <limits>
#include <string>

namespace suffuse {

/// Partial factors on permanent actions (EN 1997-1:2004, Annex A).
struct PartialFactors {
  double destabilising = 1.0;  ///< gamma_G;dst
  double stabilising = 1.0;    ///< gamma_G;stb
};

/// Uplift of a cover that conducts less than the soil below it.
struct UpliftSettings {
  std::string cover;                 ///< region; empty: not checked
  PartialFactors factors{1.0, 0.9};  ///< Table A.15
};

/// Backward erosion in a layer of sand below a roof (Sellmeijer and others 2011).
struct BackwardErosionSettings {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string layer;           ///< region of the sand; empty: not checked
  std::string entry;           ///< boundary through which water enters the layer
  std::string exit;            ///< boundary at which the pipe begins
  double length = unknown;     ///< L, m; unknown: from the drawing
  double thickness = unknown;  ///< D, m; unknown: from the drawing
  double d70 = unknown;        ///< mm; unknown: of the gradation of the layer
  double uniformity =
      unknown;              ///< U = d60/d10; unknown: of the gradation, or the mean of the tests
  double roundness = 49.8;  ///< KAS, per cent; default: mean of the tests
  double relative_density = 72.5;     ///< RD, per cent; default: mean of the tests
  bool grain_size_correction = true;  ///< the factor (d70m/d70)^0.6
};

/// Where an aquifer under a cover ends, seen from a toe of the levee.
enum class AquiferEnd { infinite, open, closed };

/// Blanket theory (EM 1110-2-1913): head below the cover at the toe of a levee.
struct BlanketSettings {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string aquifer;             ///< region; empty: not checked
  std::string cover;               ///< region that lies on it, on one side of the levee or on both
  std::string entry;               ///< boundary with the head on the riverside
  double riverside_toe = unknown;  ///< x, m
  double landside_toe = unknown;   ///< x, m
  AquiferEnd riverside = AquiferEnd::infinite;
  AquiferEnd landside = AquiferEnd::infinite;
};

struct CheckSettings {
  PartialFactors heave{1.35, 0.9};  ///< HYD, Table A.17
  UpliftSettings uplift;
  BackwardErosionSettings backward_erosion;
  BlanketSettings blanket;
};

}  // namespace suffuse
