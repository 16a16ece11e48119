// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/spectral_library.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(spectral_library) {
  const std::filesystem::path path = fuzz::file(data, size, "oak.txt");
  fuzz::may_refuse([&] {
    const SpectrumFile file = read_spectrum(path);
    const Spectrum& spectrum = *file.spectrum;
    fuzz::expect(spectrum.samples().size() <= size && spectrum.shortest() > 0 &&
                 spectrum.longest() >= spectrum.shortest());
    for (const double wavelength :
         {1e-12, spectrum.shortest(), 1064e-9, 0.5 * (spectrum.shortest() + spectrum.longest()), 1.0}) {
      const double reflectance = spectrum.reflectance(wavelength);
      fuzz::expect(reflectance >= 0 && reflectance <= 1);
    }
    fuzz::expect(!file.report.empty());
    const SpectralLibrary library = read_spectral_library(path);
    fuzz::expect(library.spectra.size() == 1 && library.spectra.contains("oak"));
  });
}
