// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_RETURNS_HPP
#define PULSECAST_DETECTOR_RETURNS_HPP

#include <pulsecast/detector/adaptor.hpp>

namespace PULSECAST_NAMESPACE {

/// Echoes of a pulse that an instrument reports.
enum class ReturnMode : std::uint8_t {
  first,               ///< the nearest
  last,                ///< the farthest
  strongest,           ///< that of the maximum amplitude; the nearest of equals
  first_and_last,      ///< both; one, if they are the same
  strongest_and_last,  ///< both; if they are the same, that and the second strongest
  n_nearest,           ///< the first `n`
  n_strongest,         ///< the strongest `n`, in order of range
};

/// Keeps some echoes of a detector: `SelectedReturns{ReturnMode::strongest, FullWaveform{}}`.
template <Detector Inner>
class SelectedReturns : public DetectorAdaptor<Inner> {
 public:
  /// `number` is that of `n_nearest` and `n_strongest`, from 1 to 255. @throws SettingError
  SelectedReturns(ReturnMode mode, Inner inside, std::size_t number = 3)
      : DetectorAdaptor<Inner>{validated(std::move(inside))}, mode_(mode), number_(number) {
    require_within("SelectedReturns (number)", number, 1, 255, "");
  }

  [[nodiscard]] Detection detect(const DetectorInput& input, auto& w) const noexcept {
    Detection d = this->inner.detect(input, w);
    if (d.echoes.size() < 2) return d;
    d.echoes = kept(d.echoes);
    number_echoes(d.echoes);
    return d;
  }

 private:
  [[nodiscard]] std::span<Echo> kept(std::span<Echo> echoes) const noexcept {
    switch (mode_) {
      case ReturnMode::first:
        return echoes.first(1);
      case ReturnMode::last:
        return echoes.last(1);
      case ReturnMode::strongest:
        return keep_strongest(echoes, 1);
      case ReturnMode::first_and_last:
        echoes[1] = echoes.back();
        return echoes.first(2);
      case ReturnMode::strongest_and_last:
        return keep_strongest(echoes, 2, 1);
      case ReturnMode::n_nearest:
        return echoes.first(std::min(echoes.size(), number_));
      case ReturnMode::n_strongest:
        return keep_strongest(echoes, number_);
    }
    return echoes;
  }
  /// Removes the weakest echoes, until `number` are left; the last `held` stay.
  static std::span<Echo> keep_strongest(std::span<Echo> echoes, std::size_t number, std::size_t held = 0) noexcept {
    while (echoes.size() > number) {
      std::size_t weakest = echoes.size() - 1 - held;
      for (std::size_t e = weakest; e-- > 0;)
        if (echoes[e].amplitude < echoes[weakest].amplitude) weakest = e;
      std::move(echoes.begin() + static_cast<std::ptrdiff_t>(weakest) + 1, echoes.end(),
                echoes.begin() + static_cast<std::ptrdiff_t>(weakest));
      echoes = echoes.first(echoes.size() - 1);
    }
    return echoes;
  }

  ReturnMode mode_;
  std::size_t number_;
};

/// What an instrument makes of echoes that arrive after the next pulse has left.
enum class RangeAmbiguity : std::uint8_t {
  folded,    ///< takes them for echoes of the last pulse: ranges are modulo c / 2f
  resolved,  ///< assigns them to their pulse; those that arrive while another leaves are lost
};

/// Detector of an instrument with multiple pulses in the air. Echoes that arrive while a pulse
/// leaves are lost: blind zones about the multiples of c / 2f.
template <Detector Inner>
class MultiplePulsesInAir : public DetectorAdaptor<Inner> {
 public:
  /// Takes pulse rate [Hz], blind range after the exit [m], and treatment. @throws SettingError
  MultiplePulsesInAir(double pulse_rate, Inner inside, double blind = 0, RangeAmbiguity in_air = RangeAmbiguity::folded)
      : DetectorAdaptor<Inner>{validated(std::move(inside))},
        ambiguity_(0.5 * speed_of_light / pulse_rate),
        blind_(blind),
        in_air_(in_air) {
    require_within("MultiplePulsesInAir (pulse rate)", pulse_rate, 1, 1e12, "Hz");
    require_within("MultiplePulsesInAir (blind)", blind, 0, ambiguity_, "m");
  }

  /// Range beyond which ranges are folded [m].
  [[nodiscard]] double ambiguity() const noexcept { return ambiguity_; }

  [[nodiscard]] Detection detect(const DetectorInput& input, auto& w) const noexcept {
    Detection d = this->inner.detect(input, w);
    const auto blind = [&](const Echo& echo) { return std::fmod(echo.range, ambiguity_) < blind_; };
    d.echoes = {d.echoes.begin(), std::remove_if(d.echoes.begin(), d.echoes.end(), blind)};
    if (in_air_ == RangeAmbiguity::folded)
      for (Echo& echo : d.echoes) echo.range = std::fmod(echo.range, ambiguity_);
    detail::number_by_range(d.echoes);
    return d;
  }

 private:
  double ambiguity_, blind_;
  RangeAmbiguity in_air_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
