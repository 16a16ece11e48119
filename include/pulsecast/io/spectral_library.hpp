// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SPECTRAL_LIBRARY_HPP
#define PULSECAST_IO_SPECTRAL_LIBRARY_HPP

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/spectra.hpp>
#include <pulsecast/material/spectrum.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Unit of reflectance in a file.
enum class ReflectanceScale : std::uint8_t { fraction, percent };

/// Content of a spectrum file.
struct SpectrumFile {
  std::shared_ptr<const Spectrum> spectrum;             ///< reflectance by wavelength, as fractions
  ReflectanceScale scale = ReflectanceScale::fraction;  ///< unit in the file; the spectrum itself has fractions
  std::string report{};                                 ///< units assumed for the columns, and the reason
  std::vector<std::string> warnings{};                  ///< oddities that could still be read
};

/// Reads a text of two columns, wavelength and reflectance, with any header and further columns; rows in any order.
/// Rows without a value, also -1.23e34 of the USGS, are left out. Units come from the header, as in the ECOSTRESS and
/// ASTER libraries ("X Units:", "Y Units:"), or from column titles in the line above the numbers. Otherwise wavelengths
/// that begin at 100 or more are nanometres, below 0.01 metres, and micrometres between; reflectances above 1.5 are
/// percent. The report states units and reasons. Throws a `FileError` with path and line at the first error.
[[nodiscard]] SpectrumFile read_spectrum(const std::filesystem::path& path);

/// Reads a file, or all files of a folder. A spectrum is named like its file without the extension; files without one
/// are left out with a warning. Throws a `FileError` if there is no spectrum at all.
[[nodiscard]] SpectralLibrary read_spectral_library(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/spectrum_reader.hpp>
#endif

#endif
