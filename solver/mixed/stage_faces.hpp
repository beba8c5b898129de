#pragma once

/// The faces of a flow: where the pressure is prescribed, which seepage faces let water out, and
/// which pieces of the mesh are connected through the faces.

#include <algorithm>
#include <optional>
#include <vector>

#include "grid/flux_correction.hpp"
#include "mixed/mixed_model.hpp"

namespace suffuse {

template <int Dim>
class StageFaces {
 public:
  StageFaces(const MixedModel<Dim>& model, const std::vector<FaceCondition>& conditions)
      : model_(model), open_(conditions.size(), 0) {
    for (const FaceCondition& c : conditions) {
      if (c.switches) switching_.push_back(static_cast<int>(kinds_.size()));
      kinds_.push_back(lasting_kind(c));
      held_.push_back(c.kind == FaceKind::pressure ? 1 : 0);
    }
    corrected_ = held_;
    any_switch_ = any_of_all(model.grid.ranks(), !switching_.empty());
    set_up_correction();
  }

  /// Whether the faces have these kinds. All faces whose kind may change count as one kind, which
  /// has an unknown.
  [[nodiscard]] bool fit(const std::vector<FaceCondition>& conditions) const {
    return std::ranges::equal(kinds_, conditions, {}, {}, lasting_kind);
  }
  [[nodiscard]] const std::vector<FaceKind>& kinds() const { return kinds_; }
  /// Faces whose kind may change, ascending.
  [[nodiscard]] const std::vector<int>& switching() const { return switching_; }
  /// Whether there are such faces, on any rank.
  [[nodiscard]] bool any_switch() const { return any_switch_; }

  /// Starts a stage with these conditions, which must outlive it. Seepage faces stay as the last
  /// stage left them.
  void start(const std::vector<FaceCondition>& conditions) {
    prescribed_ = &conditions;
    if (switching_.empty()) return;
    resolved_ = conditions;
    for (const int f : switching_) resolve(f);
  }
  /// Condition in this stage; at a seepage face, a pressure or a flux by its present state.
  [[nodiscard]] const FaceCondition& condition(int f) const {
    return switching_.empty() ? (*prescribed_)[f] : resolved_[f];
  }
  /// Whether the pressure at a face is prescribed in this stage.
  [[nodiscard]] bool is_held(int f) const { return held_[f] != 0; }
  [[nodiscard]] const std::vector<char>& held() const { return held_; }
  /// Inward flux prescribed at a face, m3/s. `porosity` per element.
  [[nodiscard]] double inflow(int f, const std::vector<double>& porosity) const {
    const FaceCondition& prescribed = condition(f);
    if (prescribed.kind == FaceKind::wall) return 0.0;
    double inward = prescribed.value;
    if (prescribed.kind == FaceKind::velocity) inward *= porosity[model_.grid.face_left[f]];
    return inward * model_.face_area[f];
  }

  /// Seepage faces are open or closed and take in no more than `most_inflow`, m3/s.
  [[nodiscard]] bool is_seepage(int f) const { return (*prescribed_)[f].kind == FaceKind::seepage; }
  [[nodiscard]] double most_inflow(int f) const {
    return (*prescribed_)[f].value * model_.face_area[f];
  }
  [[nodiscard]] bool is_open(int f) const { return open_[f] != 0; }
  /// Opens a seepage face, whose pressure is then zero, or closes it.
  void set_open(int f, bool open) {
    open_[f] = open ? 1 : 0;
    resolve(f);
  }
  /// Per face; the caller restores it before the next stage.
  [[nodiscard]] std::vector<char>& open() { return open_; }

  /// The flux correction and the sealed pieces, for the faces held at the last `follow_held`.
  [[nodiscard]] FluxCorrection<Dim>& correction() { return *correction_; }
  [[nodiscard]] const FluxCorrection<Dim>& correction() const { return *correction_; }
  void follow_held() {
    if (!any_of_all(model_.grid.ranks(), corrected_ != held_)) return;
    corrected_ = held_;
    set_up_correction();
  }

  /// Without the flux correction, which archives itself.
  void archive(auto& archive) {
    archive(on_faces(open_), on_faces(corrected_));
    if (archive.restores() && any_switch_) set_up_correction();
  }

 private:
  static FaceKind lasting_kind(const FaceCondition& c) {
    return c.switches ? FaceKind::seepage : c.kind;
  }
  void resolve(int f) {
    FaceCondition& resolved = resolved_[f];
    resolved = (*prescribed_)[f];
    if (is_seepage(f)) {
      resolved.kind = is_open(f) ? FaceKind::pressure : FaceKind::flux;
      if (is_open(f)) resolved.value = 0.0;
    }
    held_[f] = resolved.kind == FaceKind::pressure ? 1 : 0;
  }
  void set_up_correction() { correction_.emplace(model_.grid, corrected_, model_.walls); }

  const MixedModel<Dim>& model_;
  std::vector<FaceKind> kinds_;
  std::vector<int> switching_;
  bool any_switch_ = false;
  const std::vector<FaceCondition>* prescribed_ = nullptr;
  std::vector<FaceCondition> resolved_;  ///< empty if no kind may change
  std::vector<char> open_;               ///< per face: an open seepage face
  std::vector<char> held_;               ///< per face
  std::vector<char> corrected_;          ///< per face: `held_` at the last set-up of the correction
  std::optional<FluxCorrection<Dim>> correction_;
};

}  // namespace suffuse
