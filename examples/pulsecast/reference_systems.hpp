// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/spatial_reference.hpp>

#include "notes.hpp"

/// Reference system with its text (WKT 1) and units: by PROJ, from the text in a file, or else from the codes. In a
/// program built without PROJ codes stay as they are, with a note, and units are those of the text. Throws a
/// `FileError`.
pulsecast::io::SpatialReference completed(const pulsecast::io::SpatialReference& given,
                                          const std::filesystem::path& wkt, Notes& notes);

/// Reference system of the files of a run, complete; unknown for formats without one: that of the options, or that
/// which all rasters of the scene share. Unknown if there is none, or different ones. Rasters moved by their part do
/// not count. Throws a `FileError` for a system of the options that cannot be written; notes one of the rasters, and
/// heights without a system.
pulsecast::io::SpatialReference reference_system_of(const Options& options,
                                                    const pulsecast::helios::SceneSettings& scene, Notes& notes);

/// Projector of --project; empty without. Throws a `FileError` for systems that do not suit, and without PROJ.
pulsecast::io::MapProjector projector_of(const Options& options);
