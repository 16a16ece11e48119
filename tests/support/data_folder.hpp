// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace pulsecast::support {

/// Folder of the files that tests read.
inline const std::filesystem::path data_folder =
    std::filesystem::absolute(__FILE__).lexically_normal().parent_path().parent_path() / "data";

}  // namespace pulsecast::support
