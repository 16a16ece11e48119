// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/adapters/asset_search.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::adapters;

namespace {

/// Two folders of assets, one beside the other, and a secret outside.
struct Folders {
  Folders() {
    for (const char* name : {"a/x.obj", "b/x.obj", "b/y.obj", "b/sub/z.obj", "secret.obj", "b/tree1.obj", "a/tree2.obj", "a/tree2.mtl"}) {
      std::filesystem::create_directories((root / name).parent_path());
      std::ofstream(root / name) << "v 0 0 0\n";
    }
  }
  support::TemporaryFolder root{};
  AssetSearch search{{root / "a", root / "b/."}};
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

using Paths = std::vector<std::filesystem::path>;

}  // namespace

TEST_CASE("the first folder that has a file wins") {
  const Folders f;
  CHECK(f.search.folders() == Paths{f.root / "a", f.root / "b"});
  CHECK(f.search.find("x.obj").files == Paths{f.root / "a/x.obj"});
  CHECK(f.search.find("y.obj").files == Paths{f.root / "b/y.obj"});
  CHECK(f.search.find("sub\\z.obj").files == Paths{f.root / "b/sub/z.obj"});
  CHECK(f.search.find("./sub/../x.obj").files == Paths{f.root / "a/x.obj"});
  const AssetMatch none = f.search.find("w.obj");
  CHECK(none.files.empty());
  CHECK(contains(none.problem, (f.root / "a/w.obj").string()));
  CHECK(contains(none.problem, (f.root / "b/w.obj").string()));
  CHECK_FALSE(f.search.find("sub").problem.empty());  // a folder is no file
  CHECK(contains(f.search.find("").problem, "is empty"));
}

TEST_CASE("a relative path stays inside the folders; an absolute one is taken as it is") {
  const Folders f;
  CHECK(contains(f.search.find("../secret.obj").problem, "leads out of the assets folders"));
  CHECK(contains(f.search.find("sub/../../secret.obj").problem, "leads out of the assets folders"));
  CHECK(f.search.find("../b/y.obj").files == Paths{f.root / "b/y.obj"});
  CHECK(f.search.find((f.root / "secret.obj").string()).files == Paths{f.root / "secret.obj"});
  CHECK(contains(AssetSearch({}).find("x.obj").problem, "leads out"));
  CHECK(contains(AssetSearch({f.root / "b"}).find("../bb/x.obj").problem, "leads out"));  // begins alike
}

TEST_CASE("a pattern finds the files of all folders, by name") {
  const Folders f;
  CHECK(f.search.find_all("tree\\d\\.obj").files == Paths{f.root / "a/tree2.obj", f.root / "b/tree1.obj"});
  CHECK(f.search.find_all("sub/.*").files == Paths{f.root / "b/sub/z.obj"});
  CHECK(f.search.find_all((f.root / "b/(x|y).obj").string()).files == Paths{f.root / "b/x.obj", f.root / "b/y.obj"});
  CHECK(contains(f.search.find_all("tree").problem, "matches no file"));  // of the whole name
  CHECK(contains(f.search.find_all("../.*").problem, "leads out"));
  CHECK(contains(f.search.find_all("[").problem, "no regular expression"));
}

TEST_CASE("patterns that could take for ever are refused") {
  const Folders f;
  for (const char* pattern : {"(a+)+b", "(.*)*x", "a*a*a*a*a*b", "a?a?a?a?a?a?a?a?a?aaaaaaaaa",
                              "(x|x)(x|x)(x|x)(x|x)(x|x)(x|x)(x|x)(x|x)(x|x)", "(a)\\1", "(a){9}", "a{9}{9}{9}{9}{9}"}) {
    CAPTURE(pattern);
    CHECK(contains(f.search.find_all(pattern).problem, "matched quickly"));
  }
  CHECK(contains(f.search.find_all(std::string(300, 'a')).problem, "matched quickly"));
}
