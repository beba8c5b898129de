#pragma once

/// The faces of a flow: at which of them the pressure is prescribed, which seepage faces let water
/// out, and how the pieces of the mesh hang together through them.

#include <algorithm>
#include <optional>
#include <vector>

#include "mixed/flux_correction.hpp"
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
    set_up_correction();
  }

  /// Whether these are the kinds of the faces. Faces whose kind may change count as one kind, which
  /// has an unknown.
  [[nodiscard]] bool fit(const std::vector<FaceCondition>& conditions) const {
    return std::ranges::equal(kinds_, conditions, {}, {}, lasting_kind);
  }
  [[nodiscard]] const std::vector<FaceKind>& kinds() const { return kinds_; }
  /// Faces whose kind may change, ascending.
  [[nodiscard]] const std::vector<int>& switching() const { return switching_; }

  /// Takes the conditions of a stage, which outlive it, with seepage faces as the last stage left
  /// them.
  void start(const std::vector<FaceCondition>& conditions) {
    prescribed_ = &conditions;
    if (switching_.empty()) return;
    resolved_ = conditions;
    for (const int f : switching_) resolve(f);
  }
  /// Condition in this stage: at a seepage face a pressure or a flux, as it is now.
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

  /// Seepage faces have an inflow that they take in at most, m3/s, and are open or closed.
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
  /// Per face, to be put back before a stage starts.
  [[nodiscard]] std::vector<char>& open() { return open_; }

  /// The flux correction and the sealed pieces of the faces that `follow_held` met held last.
  [[nodiscard]] FluxCorrection<Dim>& correction() { return *correction_; }
  [[nodiscard]] const FluxCorrection<Dim>& correction() const { return *correction_; }
  void follow_held() {
    if (corrected_ == held_) return;
    corrected_ = held_;
    set_up_correction();
  }

  /// The flux correction archives itself.
  void archive(auto& archive) {
    archive(open_, corrected_);
    if (archive.restores() && !switching_.empty()) set_up_correction();
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
  void set_up_correction() {
    std::vector<FaceCondition> conditions(corrected_.size(), {.kind = FaceKind::wall});
    for (std::size_t f = 0; f < conditions.size(); ++f) {
      if (corrected_[f] != 0) conditions[f].kind = FaceKind::pressure;
    }
    correction_.emplace(model_.grid, conditions, model_.walls);
  }

  const MixedModel<Dim>& model_;
  std::vector<FaceKind> kinds_;
  std::vector<int> switching_;
  const std::vector<FaceCondition>* prescribed_ = nullptr;  ///< of the stage
  std::vector<FaceCondition> resolved_;                     ///< where kinds may change
  std::vector<char> open_;       ///< per face: a seepage face that lets water out
  std::vector<char> held_;       ///< per face
  std::vector<char> corrected_;  ///< per face: held in the flux correction as it stands
  std::optional<FluxCorrection<Dim>> correction_;
};

}  // namespace suffuse
