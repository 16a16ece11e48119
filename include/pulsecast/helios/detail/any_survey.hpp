// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_ANY_SURVEY_HPP
#define PULSECAST_HELIOS_DETAIL_ANY_SURVEY_HPP

#include <cstddef>
#include <memory>
#include <utility>

#include <pulsecast/pulse.hpp>
#include <pulsecast/survey.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

/// Type-erased survey of any receiver: code that runs or samples it compiles once, and the pipeline of each kind in one
/// place.
class AnySurvey {
 public:
  struct Scratch {
    virtual ~Scratch() = default;
  };
  using Workspace = std::unique_ptr<Scratch>;

  AnySurvey() = default;
  AnySurvey(const AnySurvey&) = delete;
  AnySurvey& operator=(const AnySurvey&) = delete;
  virtual ~AnySurvey() = default;
  [[nodiscard]] virtual Workspace workspace() const = 0;
  [[nodiscard]] virtual PulseIndex size() const noexcept = 0;
  [[nodiscard]] virtual std::size_t subrays() const noexcept = 0;
  [[nodiscard]] virtual std::size_t recorded_subrays() const noexcept = 0;
  [[nodiscard]] virtual double sample_interval() const noexcept = 0;
  [[nodiscard]] virtual PulseIndex next_pulse(PulseIndex i) const noexcept = 0;
  [[nodiscard]] virtual Outcome operator()(PulseIndex i, Workspace& w) const noexcept = 0;

  template <class Next>
  void simulate_in_order(PulseIndex i, PulseIndex end, Workspace& w, const Next& next) const {
    simulate(
        i, end, w, [](const void* n, const Outcome& outcome) { return (*static_cast<const Next*>(n))(outcome); },
        &next);
  }

 protected:
  /// Calls `next`, of which it is given the address.
  using CallNext = PulseIndex (*)(const void*, const Outcome&);
  virtual void simulate(PulseIndex i, PulseIndex end, Workspace& w, CallNext call, const void* next) const = 0;
};

/// Wraps a `Survey` of one kind as an `AnySurvey`.
template <SkipsBlocked Survey>
class SurveyOf final : public AnySurvey {
 public:
  explicit SurveyOf(Survey survey) : survey_(std::move(survey)) {}
  [[nodiscard]] Workspace workspace() const override { return std::make_unique<Own>(survey_.workspace()); }
  [[nodiscard]] PulseIndex size() const noexcept override { return survey_.size(); }
  [[nodiscard]] std::size_t subrays() const noexcept override { return survey_.subrays(); }
  [[nodiscard]] std::size_t recorded_subrays() const noexcept override { return survey_.recorded_subrays(); }
  [[nodiscard]] double sample_interval() const noexcept override { return survey_.sample_interval(); }
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept override { return survey_.next_pulse(i); }
  [[nodiscard]] Outcome operator()(PulseIndex i, Workspace& w) const noexcept override {
    return survey_(i, static_cast<Own&>(*w).own);
  }

 protected:
  void simulate(PulseIndex i, PulseIndex end, Workspace& w, CallNext call, const void* next) const override {
    survey_.simulate_in_order(i, end, static_cast<Own&>(*w).own,
                              [&](const Outcome& outcome) { return call(next, outcome); });
  }

 private:
  struct Own : Scratch {
    explicit Own(typename Survey::Workspace w) : own(std::move(w)) {}
    typename Survey::Workspace own;
  };
  Survey survey_;
};

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
