#pragma once

/// A continuous head, linear in each element, near the head of the mixed elements: any such head
/// with the prescribed values bounds the energy of the flow from above.

#include <optional>
#include <vector>

#include "bounds/seepage_fields.hpp"

namespace suffuse {

/// Per node, m. `face_head`: of the mixed elements, at the centres of faces, m. `prescribed`: per
/// node, m. Starts with the mean of what the elements around a node have there, weighted with their
/// conductivity, and comes nearer to the best such head by conjugate gradients, until they hardly
/// narrow the gap to `of_flux`, the slopes of fluxes that balance.
template <int Dim>
std::vector<double> conforming_head(const SeepageEnergy<Dim>& energy,
                                    const std::vector<double>& face_head,
                                    const Slopes<Dim>& of_flux,
                                    const std::vector<std::optional<double>>& prescribed);

}  // namespace suffuse
