#include "mixed/side_states.hpp"

#include "grid/parallel.hpp"

namespace suffuse {

template <int Dim>
SideStates<Dim>::SideStates(const MixedModel<Dim>& model, const std::vector<double>& pressure)
    : model_(model), pressure_(pressure), of_left_(pressure.size()) {
  for_each_index(model.grid.face_count(), model.settings.threads, [&](int f) {
    of_left_[f] = model.soils.at(model.grid.face_left[f], pressure[f]);
  });
}

template class SideStates<2>;
template class SideStates<3>;

}  // namespace suffuse
