// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/python/ray_queries.hpp>

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <pybind11/embed.h>
#include <pybind11/stl.h>

#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "python/interpreter.hpp"

using namespace pulsecast;
namespace py = pybind11;

static_assert(sizeof(python::detail::HitRow) == 128);

namespace {

using Doors = MovingScene<TriangleMesh<>>;

/// A triangle 10 m to the north, which moves east at 2 m/s.
std::unique_ptr<Doors> door() {
  const MeshData mesh{.vertices = {{-1, 10, 0}, {1, 10, 0}, {0, 10, 2}}, .triangles = {{0, 1, 2}}};
  const auto slide = std::make_shared<const PartMotion>(SteadyMotion{.velocity = {2, 0, 0}});
  return std::make_unique<Doors>(std::vector<Doors::Part>{{.geometry = std::make_shared<const TriangleMesh<>>(mesh),
                                                           .object = 5,
                                                           .motion = slide,
                                                           .attributes = attributes({{"age", 7.5}, {"wood", 1}})}},
                                 MovingIndexSettings{.to = 10});
}

PYBIND11_EMBEDDED_MODULE(doors, m) {
  py::class_<Doors> bound(m, "Door");
  bound.def(py::init(&door));
  python::bind_ray_queries(bound);
}

}  // namespace

TEST_CASE("rays of several times meet a moving part of a scene of one's own") {
  py::dict scope = support::python_names("import doors, numpy");
  py::exec("hits = doors.Door().closest_hits([[0, 0, 0.5], [6, 0, 0.5], [6, 0, 0.5]], [[0, 1, 0]] * 3, time=[0, 0, 3])",
           scope);
  CHECK(py::eval("hits['range'].tolist()", scope).cast<std::vector<double>>() ==
        std::vector<double>{10, std::numeric_limits<double>::infinity(), 10});
  CHECK(py::eval("hits['velocity'][:, 0].tolist()", scope).cast<std::vector<double>>() == std::vector<double>{2, 0, 2});
  CHECK(py::eval("hits['object'].tolist()", scope).cast<std::vector<int>>() == std::vector<int>{5, 0, 5});
  CHECK(py::eval("doors.Door().occluded([[6, 0, 0.5, 0, 1, 0]], time=3).tolist()", scope).cast<std::vector<bool>>() ==
        std::vector<bool>{true});
}

TEST_CASE("a sensor at several poses measures each in the scene of its own, into a given array") {
  py::dict scope = support::python_names("import doors, numpy");
  py::exec("poses = numpy.tile(numpy.eye(4), (2, 1, 1))\nposes[1, 1, 3] = 4\nout = numpy.zeros((2, 1), numpy.float32)",
           scope);
  py::exec("rays = [[0, 0, 0.5, 0, 1, 0]]\ndoor = doors.Door()", scope);
  CHECK(py::eval("door.run_batch(poses, rays, out=out) is out", scope).cast<bool>());
  CHECK(py::eval("out[:, 0].tolist()", scope).cast<std::vector<double>>() == std::vector<double>{10, 6});
  CHECK(py::eval("doors.Door.run_batch_in([door, doors.Door()], [1, 0], poses, rays).tobytes() == out.tobytes()", scope)
            .cast<bool>());
  for (const char* wrong :
       {"doors.Door.run_batch_in([door], [0, 1], poses, rays)", "doors.Door.run_batch_in([door], [0], poses, rays)",
        "doors.Door.run_batch_in([door], [0, -1], poses, rays)", "doors.Door.run_batch_in([], [0, 0], poses, rays)",
        "doors.Door.run_batch_in([door], [0.5, 0], poses, rays)",
        "door.run_batch(poses, rays, out=numpy.zeros((2, 1)))",
        "door.run_batch(poses, rays, out=numpy.zeros((1, 2), numpy.float32))",
        "door.run_batch(poses, rays, out=numpy.zeros((2, 2), numpy.float32)[:, :1])"})
    CHECK_THROWS_AS(py::eval(wrong, scope), py::error_already_set);
}

TEST_CASE("attributes of hits are those of their objects, in the shape of the question") {
  py::dict scope = support::python_names("import doors, numpy");
  py::exec("door = doors.Door()\nhits = door.closest_hits([[0, 0, 0.5], [6, 0, 0.5]], [[0, 1, 0]] * 2, time=0)", scope);
  py::exec("told = door.attributes_of(hits['object'])", scope);
  CHECK(py::eval("list(told)", scope).cast<std::vector<std::string>>() == std::vector<std::string>{"age", "wood"});
  CHECK(py::eval("told['age'][0]", scope).cast<double>() == 7.5);
  CHECK(py::eval("bool(numpy.isnan(told['age'][1]))", scope).cast<bool>());  // a miss has object 0
  py::exec("told = door.attributes_of([[5, 4, -1], [5 + 2**32, 0, 5]])", scope);
  CHECK(py::eval("numpy.nan_to_num(told['wood'], nan=-1).tolist()", scope).cast<std::vector<std::vector<double>>>() ==
        std::vector<std::vector<double>>{{1, -1, -1}, {-1, -1, 1}});
  CHECK(py::eval("door.attributes_of(numpy.zeros(0, int))['age'].shape == (0,)", scope).cast<bool>());
  for (const char* wrong : {"[1.5]", "None", "[[1], [2, 3]]", "'door'"})
    CHECK_THROWS_AS(py::eval(std::string("door.attributes_of(") + wrong + ")", scope), py::error_already_set);
}
