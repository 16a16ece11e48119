# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Conan 2 recipe, of the sources it stands among: `conan create docs/packaging/conan`."""

from pathlib import Path

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, cmake_layout
from conan.tools.files import copy


class Pulsecast(ConanFile):
    name = "pulsecast"
    version = "0.3.0"
    license = "MIT"
    description = "Virtual laser scanning: a header-only C++20 library"
    package_type = "header-library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"files": [True, False]}  # targets that read OBJ, GeoTIFF, XML and compressed text, and write PNG
    default_options = {"files": False}
    generators = "CMakeDeps", "CMakeToolchain"

    def export_sources(self):
        root = Path(self.recipe_folder).parents[2]
        for pattern in ("CMakeLists.txt", "LICENSE", "include/*", "examples/*", "bench/*", "docs/packaging/*"):
            copy(self, pattern, root, self.export_sources_folder)

    def requirements(self):
        self.requires("glm/0.9.9.8", transitive_headers=True)
        if self.options.files:
            for library in ("eigen/3.4.0", "libtiff/4.6.0", "pugixml/1.14", "stb/cci.20230920", "tinyobjloader/2.0.0-rc10",
                            "xxhash/0.8.2", "zlib/1.3.1"):
                self.requires(library, transitive_headers=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def build(self):
        cmake = CMake(self)
        cmake.configure({"BUILD_TESTING": "OFF", "PULSECAST_PROGRAMS": "OFF"})

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, str(Path(self.package_folder) / "licenses"))

    def package_id(self):
        self.info.clear()

    def package_info(self):
        # the package's own pulsecastConfig.cmake has a target for each adapter
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["share/cmake/pulsecast"]
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
