// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/mesh_file/gltf_document.hpp>

#include <string>
#include <vector>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

/// The input is a glTF or GLB file whose buffers are the input, too. What is made for assimp is read again.
FUZZ_TARGET(gltf) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::filesystem::path path = "a.gltf";
  std::vector<std::string> warnings;
  fuzz::may_refuse([&] {
    const auto open = [&](const std::string&) { return input; };
    const io::detail::GltfDocument document(path, input, open, warnings);
    const std::string made(document.files().at("<document>.gltf"));
    const io::detail::GltfDocument again(path, made, open, warnings);
    fuzz::expect(again.instances.empty());
  });
}
