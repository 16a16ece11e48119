// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SENSOR_KIT_HPP
#define PULSECAST_SENSOR_KIT_HPP

#include <pulsecast/any_survey.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>

namespace PULSECAST_NAMESPACE {

/// Sink that begins anew with each scan, as `io::PointBuffer`.
template <class S>
concept ScanSink = EchoSink<S> && requires(S& sink, Tick start) {
  sink.begin_scan(start);
};

/// Sensors of a robot, which a loop steps from one time to the next. Scan n of a sensor is that of the times from
/// n / rate up to (n + 1) / rate, sample n is due at n / rate, in time since the start of the survey. All calls of the
/// user's functions come on the caller's thread, by the time at which they are due, then in the order of adding. They
/// and their data depend on the poses and the map during a step alone: not on threads, executor or other sensors, nor
/// on the length of the steps where poses are functions of time. No pose outlives a step.
class SensorKit {
 public:
  explicit SensorKit(Tick start = {}) : time_(start) {}  ///< time from which the first step goes on

  /// Adds a sensor that scans from the kit's time on, beginning with its next whole scan, up to the end of its survey:
  /// `kit.add_scans("lidar", survey, 10, io::PointBuffer(layout, settings), [&](const io::PointBuffer& scan) {})`.
  /// `scan_rate` is from 1e-3 to 1e6 [Hz]. The sink is told the start of a scan in the step of this, then gets the
  /// pulses of this and of later steps, as of a run. `take` is called when the scan is due, at its end. Slots come in
  /// their order: pulses of a leg that begins before others end come late, in a scan after their own.
  /// @throws SettingError for a rate out of range, a name that the kit has, or a survey that finds no slots
  template <ScanSink Sink, class Take>
  requires std::invocable<Take&, const Sink&>
  void add_scans(std::string name, AnySurvey survey, double scan_rate, Sink sink, Take take) {
    check(name, scan_rate);
    if (survey.size() > 0 && survey.slot_from({std::int64_t{1} << 40, 0}) == 0)
      throw SettingError(label(name), " has a survey that finds no slots: expected a source with slot_from(tick)");
    sensors_.push_back(std::make_unique<Scans<Sink, Take>>(std::move(name), scan_rate, time_, std::move(survey),
                                                           std::move(sink), std::move(take)));
  }

  /// Adds what is sampled at a rate, from 1e-3 to 1e6 [Hz], from the kit's time on: poses, inertial samples, clocks.
  /// `sample(i, tick)` is called when sample i is due, at Tick::of(i, rate): also for one due at the end of a step, so
  /// that it sees the poses of that. @throws SettingError
  template <class Sample>
  requires std::invocable<Sample&, PulseIndex, Tick>
  void add_samples(std::string name, double rate, Sample sample) {
    check(name, rate);
    sensors_.push_back(std::make_unique<Samples<Sample>>(std::move(name), rate, time_, std::move(sample)));
  }

  /// Simulates all sensors up to a time: slots before it, samples and ends of scans until and at it. Sensors follow one
  /// another, each on the threads of `workers`: several kits run side by side, `{pool, 1}` each. With a `ThreadPool`,
  /// steps soon allocate nothing. @throws SettingError for an earlier time than the kit's, or a step within a step
  /// @throws std::runtime_error as `run`; the kit is then of no use
  void step(Tick until, const Workers& workers = {}) {
    if (busy_)
      throw SettingError("SensorKit::step",
                         " is called in a step, or after one whose simulation failed: expected none");
    if (until < time_)
      throw_setting_error("SensorKit::step (until)", until.seconds(), "s",
                          text::joined({"at least ", text::to_text(time_.seconds()), ", the time of the last step"}));
    do {
      Tick end = until;  // a sink holds one scan, which is passed on before the next begins
      for (const auto& sensor : sensors_)
        if (sensor->scans) end = std::min(end, sensor->due());
      busy_ = true;                                      // for ever, if a run fails
      for (std::size_t k = 0; k < sensors_.size(); ++k)  // a sink may add sensors
        sensors_[k]->simulate(end, {.threads = workers.count(), .executor = workers.executor()});
      time_ = end;
      const Delivery delivery{busy_};
      while (Sensor* const next = next_due()) next->deliver();
    } while (time_ < until);
  }

  [[nodiscard]] Tick time() const noexcept { return time_; }  ///< up to which it was stepped

 private:
  /// Ends that a kit is busy, also by an exception of the user's.
  struct Delivery {
    bool& busy;
    ~Delivery() { busy = false; }
  };

  struct Sensor {
    std::string name;
    double rate;
    PulseIndex number;  ///< of the next scan or sample: the first that begins at the kit's time or after
    bool scans;

    Sensor(std::string of_name, double of_rate, Tick from, bool of_scans)
        : name(std::move(of_name)),
          rate(of_rate),
          number(Scanner{.pulse_rate = rate, .pulses = PulseIndex{1} << 52}.slot_from(from)),
          scans(of_scans) {}
    virtual ~Sensor() = default;
    [[nodiscard]] virtual Tick due() const noexcept { return Tick::of(number, rate); }
    virtual void simulate(Tick, const RunOptions&) {}
    virtual void deliver() = 0;
  };

  template <class Sink, class Take>
  struct Scans final : Sensor {
    AnySurvey survey;
    Sink sink;
    Take take;
    PulseIndex slot;     ///< the next one
    bool begun = false;  ///< true if the sink has the start of the scan

    Scans(std::string of_name, double of_rate, Tick from, AnySurvey of_survey, Sink to_sink, Take to_take)
        : Sensor(std::move(of_name), of_rate, from, true),
          survey(std::move(of_survey)),
          sink(std::move(to_sink)),
          take(std::move(to_take)),
          slot(survey.slot_from(Tick::of(this->number, this->rate))) {}

    [[nodiscard]] Tick due() const noexcept override {
      if (!begun && slot == survey.size()) return {std::numeric_limits<std::int64_t>::max(), 0};
      return Tick::of(this->number + 1, this->rate);
    }
    void simulate(Tick end, const RunOptions& options) override {
      const Tick start = Tick::of(this->number, this->rate);
      if (!(start < end) || (!begun && slot == survey.size())) return;
      if (!std::exchange(begun, true)) sink.begin_scan(start);
      RunOptions part = options;
      part.first = slot;
      part.end = slot = std::max(slot, survey.slot_from(end));
      if (part.first < part.end) run(survey, part, sink);
    }
    void deliver() override {
      begun = false;
      ++this->number;
      take(std::as_const(sink));
    }
  };

  template <class Sample>
  struct Samples final : Sensor {
    Sample sample;

    Samples(std::string of_name, double of_rate, Tick from, Sample of_sample)
        : Sensor(std::move(of_name), of_rate, from, false), sample(std::move(of_sample)) {}
    void deliver() override {
      const PulseIndex i = this->number++;
      sample(i, Tick::of(i, this->rate));
    }
  };

  static std::string label(const std::string& name) { return text::joined({"sensor '", name, "'"}); }

  void check(const std::string& name, double rate) const {
    naming(label(name), [&] { require_within("rate", rate, 1e-3, 1e6, "Hz"); });
    for (const auto& sensor : sensors_)
      if (sensor->name == name) throw SettingError(label(name), " has the name of another: expected one of its own");
  }

  /// First sensor of those that are due the earliest, by the kit's time; null if none is due.
  [[nodiscard]] Sensor* next_due() const noexcept {
    Sensor* first = nullptr;
    for (const auto& sensor : sensors_)
      if (sensor->due() <= time_ && (!first || sensor->due() < first->due())) first = sensor.get();
    return first;
  }

  Tick time_;
  bool busy_ = false;
  std::vector<std::unique_ptr<Sensor>> sensors_;  // in the order of adding
};

}  // namespace PULSECAST_NAMESPACE

#endif
