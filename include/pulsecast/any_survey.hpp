// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ANY_SURVEY_HPP
#define PULSECAST_ANY_SURVEY_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Survey of any type, for surveys that are chosen at run time, and for several kinds in one container:
/// `std::vector<AnySurvey>{Survey{...}, Survey{...}}`. Copies share the survey. `run` makes one virtual call for a
/// sequence of slots, so that pulses cost what they cost without it.
class AnySurvey {
  struct Scratch {
    virtual ~Scratch() = default;
  };
  using Next = PulseIndex (*)(const void* next, const Outcome&);  // calls `next`

  struct Model {
    virtual ~Model() = default;
    [[nodiscard]] virtual std::unique_ptr<Scratch> workspace() const = 0;
    [[nodiscard]] virtual PulseIndex size() const noexcept = 0;
    [[nodiscard]] virtual std::size_t subrays() const noexcept = 0;
    [[nodiscard]] virtual std::size_t recorded_subrays() const noexcept = 0;
    [[nodiscard]] virtual double sample_interval() const noexcept = 0;
    [[nodiscard]] virtual PulseIndex slot_from(Tick t) const noexcept = 0;
    [[nodiscard]] virtual PulseIndex next_pulse(PulseIndex i) const noexcept = 0;
    [[nodiscard]] virtual Outcome outcome(PulseIndex i, Scratch& w) const noexcept = 0;
    virtual void simulate(PulseIndex i, PulseIndex end, Scratch& w, Next call, const void* next) const = 0;
  };

 public:
  using refinements = refines<tag::FindsSlots, tag::SkipsBlocked, tag::SimulatesInOrder, tag::IdentifiedSurvey>;
  /// Scratch memory of one worker.
  using Workspace = std::unique_ptr<Scratch>;

  /// Takes a survey, and what it refers to, such as its map: `owner` lives as long as the survey.
  template <class Survey>
  requires(!std::same_as<Survey, AnySurvey> && PulseSurvey<Survey>)
      AnySurvey(Survey survey,
                std::shared_ptr<const void> owner = {})  // NOLINT(google-explicit-constructor): on purpose
      : owner_(std::move(owner)), survey_(std::make_shared<const Own<Survey>>(std::move(survey))) {}

  [[nodiscard]] Workspace workspace() const { return survey_->workspace(); }
  [[nodiscard]] PulseIndex size() const noexcept { return survey_->size(); }
  [[nodiscard]] std::size_t subrays() const noexcept { return survey_->subrays(); }
  [[nodiscard]] std::size_t recorded_subrays() const noexcept { return survey_->recorded_subrays(); }
  [[nodiscard]] double sample_interval() const noexcept { return survey_->sample_interval(); }
  /// As the concept FindsSlots describes; 0 for a survey that does not.
  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept { return survey_->slot_from(t); }
  /// As the concept SkipsBlocked describes; `i` itself for a survey that does not.
  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept { return survey_->next_pulse(i); }
  /// As the concept IdentifiedSurvey requires.
  [[nodiscard]] std::shared_ptr<const void> identity() const noexcept { return survey_; }
  [[nodiscard]] Outcome operator()(PulseIndex i, Workspace& w) const noexcept { return survey_->outcome(i, *w); }
  /// As the concept SimulatesInOrder requires.
  template <class Function>
  void simulate_in_order(PulseIndex i, PulseIndex end, Workspace& w, const Function& next) const {
    survey_->simulate(
        i, end, *w, [](const void* f, const Outcome& outcome) { return (*static_cast<const Function*>(f))(outcome); },
        &next);
  }

 private:
  template <class Survey>
  struct Own final : Model {
    struct OwnScratch final : Scratch {
      explicit OwnScratch(const Survey& survey) : workspace(survey.workspace()) {}
      decltype(std::declval<const Survey&>().workspace()) workspace;  // which need not be movable
    };
    static auto& of(Scratch& w) noexcept { return static_cast<OwnScratch&>(w).workspace; }

    explicit Own(Survey s) : survey(std::move(s)) {}
    [[nodiscard]] Workspace workspace() const override { return std::make_unique<OwnScratch>(survey); }
    [[nodiscard]] PulseIndex size() const noexcept override { return survey.size(); }
    [[nodiscard]] std::size_t subrays() const noexcept override { return survey.subrays(); }
    [[nodiscard]] std::size_t recorded_subrays() const noexcept override { return survey.recorded_subrays(); }
    [[nodiscard]] double sample_interval() const noexcept override { return survey.sample_interval(); }
    [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept override {
      if constexpr (FindsSlots<Survey>) return survey.slot_from(t);
      return 0;
    }
    [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept override {
      if constexpr (SkipsBlocked<Survey>) return survey.next_pulse(i);
      return i;
    }
    [[nodiscard]] Outcome outcome(PulseIndex i, Scratch& w) const noexcept override { return survey(i, of(w)); }
    void simulate(PulseIndex i, PulseIndex end, Scratch& w, Next call, const void* next) const override {
      if constexpr (SimulatesInOrder<Survey>)
        survey.simulate_in_order(i, end, of(w), [&](const Outcome& outcome) { return call(next, outcome); });
      else
        while (i < end) i = call(next, survey(i, of(w)));
    }

    Survey survey;
  };

  std::shared_ptr<const void> owner_;  // outlives the survey
  std::shared_ptr<const Model> survey_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
