#pragma once

/// Schemes of the flow and their settings, for tests that every scheme must pass.

#include <ostream>

#include "scene/scene.hpp"

namespace suffuse::model {

struct SchemeCase {
  const char* name;
  FlowScheme scheme;
  double step;  ///< s; 0: the scheme's own choice
  TransportScheme transport = TransportScheme::by_count;
  double least_order = 1.5;  ///< of transport, from 1/8 to 1/32

  void apply(Scene& scene) const {
    scene.time.scheme = scheme;
    scene.time.transport = transport;
    if (step > 0.0) scene.time.step = step;
  }
};

inline std::ostream& operator<<(std::ostream& out, const SchemeCase& scheme) {
  return out << scheme.name;
}

inline constexpr SchemeCase explicit_scheme{"explicit", FlowScheme::explicit_nodal, 0.0};
inline constexpr SchemeCase implicit_scheme{"implicit", FlowScheme::implicit_mixed, 0.0};
inline constexpr SchemeCase implicit_one_second{"implicit_one_second", FlowScheme::implicit_mixed,
                                                1.0};
inline constexpr SchemeCase implicit_transport{"implicit_transport", FlowScheme::implicit_mixed,
                                               0.25, TransportScheme::implicit_sweeps,
                                               // Its error on the coarse mesh is smaller than that
                                               // of the others.
                                               1.45};

}  // namespace suffuse::model
