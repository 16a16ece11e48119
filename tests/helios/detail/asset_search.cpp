// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/asset_search.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/file_errors.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// Two folders of assets, one beside the other, and a secret outside.
struct Folders {
  Folders() {
    for (const char* name :
         {"a/x.obj", "b/x.obj", "b/y.obj", "b/sub/z.obj", "secret.obj", "b/tree1.obj", "a/tree2.obj", "a/tree2.mtl"}) {
      std::filesystem::create_directories((root / name).parent_path());
      std::ofstream(root / name) << "v 0 0 0\n";
    }
  }
  support::TemporaryFolder root{};
  AssetSearch search{{root / "a", root / "b/."}};
};

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

TEST_CASE("a relative path that leads out of the folders is taken with a warning, after those that do not") {
  const Folders f;
  for (const char* name : {"../secret.obj", "sub/../../secret.obj"}) {
    const AssetMatch match = f.search.find(name);
    CHECK(match.files == Paths{f.root / "secret.obj"});
    CHECK(match.warning == "is outside the assets folders: " + (f.root / "secret.obj").string());
  }
  const AssetMatch inside = f.search.find("../b/y.obj");
  CHECK(inside.files == Paths{f.root / "b/y.obj"});
  CHECK(inside.warning.empty());
  std::ofstream(f.root / "x.obj") << "v 0 0 0\n";
  CHECK(AssetSearch({f.root / "b/sub", f.root / "a"}).find("../x.obj").files == Paths{f.root / "b/x.obj"});
  CHECK(AssetSearch({f.root / "a", f.root / "b/sub", f.root / "b"}).find("../x.obj").warning.empty());
  const AssetMatch absolute = f.search.find((f.root / "secret.obj").string());
  CHECK(absolute.files == Paths{f.root / "secret.obj"});
  CHECK(absolute.warning.empty());
  CHECK(contains(AssetSearch({}).find("x.obj").problem, "does not exist"));
  std::filesystem::create_directories(f.root / "bb");
  std::ofstream(f.root / "bb/x.obj") << "v 0 0 0\n";
  CHECK(contains(AssetSearch({f.root / "b"}).find("../bb/x.obj").warning, "is outside"));  // begins alike
  CHECK(contains(f.search.find("../none.obj").problem, "does not exist"));
}

TEST_CASE("a pattern finds the files of all folders, by name") {
  const Folders f;
  CHECK(f.search.find_all("tree\\d\\.obj").files == Paths{f.root / "a/tree2.obj", f.root / "b/tree1.obj"});
  CHECK(f.search.find_all("sub/.*").files == Paths{f.root / "b/sub/z.obj"});
  CHECK(f.search.find_all((f.root / "b/(x|y).obj").string()).files == Paths{f.root / "b/x.obj", f.root / "b/y.obj"});
  CHECK(contains(f.search.find_all("tree").problem, "matches no file"));  // of the whole name
  const AssetMatch outside = f.search.find_all("../.*\\.obj");
  CHECK(outside.files == Paths{f.root / "secret.obj"});
  CHECK(contains(outside.warning, "is outside"));
  CHECK(contains(f.search.find_all("[").problem, "end with a regular expression"));
}

TEST_CASE("a pattern that backtracking would follow for ever is matched at once, against a long name too") {
  const Folders f;
  std::ofstream(f.root / "a" / std::string(250, 'a')) << "v 0 0 0\n";
  for (const char* pattern : {"(a+)+b", "(.*)*x", "a*a*a*a*b", "a*a*a*a*a*a*a*a*b", "(a|aa)+b", "(a|a)*(a|a)*b"}) {
    CAPTURE(pattern);
    CHECK(contains(f.search.find_all(pattern).problem, "matches no file"));
  }
  CHECK(f.search.find_all("(a|aa)+").files == Paths{f.root / "a" / std::string(250, 'a')});
  CHECK(f.search.find_all("(tree|bush)+\\d{1,3}\\.obj").files == Paths{f.root / "a/tree2.obj", f.root / "b/tree1.obj"});
}

TEST_CASE("patterns whose states have no bound are refused") {
  const Folders f;
  for (const char* pattern : {"(a)\\1", "(a){9}", "a{9}{9}{9}{9}{9}"}) {
    CAPTURE(pattern);
    CHECK(contains(f.search.find_all(pattern).problem, "supported regular expression"));
  }
  CHECK(contains(f.search.find_all(std::string(300, 'a')).problem, "supported regular expression"));
}
