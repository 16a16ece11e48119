// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_SPECTRA_HPP
#define PULSECAST_IO_DETAIL_SPECTRA_HPP

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/material/spectrum.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Spectra by name.
struct SpectralLibrary {
  std::map<std::string, std::shared_ptr<const Spectrum>, std::less<>> spectra{};  ///< spectra by name
  std::vector<std::string> reports{};   ///< report of each file, as in `SpectrumFile`
  std::vector<std::string> warnings{};  ///< oddities that could still be read
  std::vector<double>
      wavelengths{};  ///< of the lasers, if known: materials whose spectra do not reach them cause a warning [m]
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
