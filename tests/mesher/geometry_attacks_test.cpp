/// Geometry files that try to do more than describe a geometry. None may leave a trace.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "common/errors.hpp"
#include "geometry.hpp"
#include "temporary_folder.hpp"

namespace suffuse {
namespace geometry_attacks_test {

namespace fs = std::filesystem;

const std::string square =
    "Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,1,0}; Point(4)={0,1,0};\n"
    "Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};\n"
    "Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1}; Physical Surface(\"specimen\")={1};\n";

struct Attack {
  std::string name;
  std::string commands;  // follow the square; @ is the folder
  std::string says;      // part of the message
};

void PrintTo(const Attack& attack, std::ostream* stream) {
  *stream << attack.name;
}

class Attacks : public testing::TestWithParam<Attack> {
 protected:
  std::string refusal(const std::string& commands) const {
    std::string text = square + commands + '\n';
    for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@')) {
      text.replace(at, 1, folder_.path().string());
    }
    folder_.write("a.geo", text);
    try {
      const SceneDocument document =
          parse_scene(test::scene_text("[geometry]\nfile = \"a.geo\"\n[mesh]\nsize = 0.5\n"),
                      folder_.file("scene.toml"));
      build_geometry({document, 20.0});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  test::TemporaryFolder folder_;
};

TEST_P(Attacks, AreRefusedAndLeaveNoTrace) {
  const std::string canary = folder_.write("canary", "alive");
  const std::string evil =
      folder_.write("evil.txt", "SystemCall \"touch " + folder_.file("trace") + "\";\n");
  ASSERT_EQ(::mkfifo(folder_.file("fifo").c_str(), 0600), 0);
  const std::string message = refusal(GetParam().commands);
  EXPECT_NE(message.find(GetParam().says), std::string::npos) << message;
  EXPECT_EQ(test::read_file(canary), "alive");
  EXPECT_EQ(folder_.count(), 4) << "something was made or removed";
  EXPECT_FALSE(fs::exists("trace"));
}

const std::string command = "has Gmsh run a command or start a process";
const std::string writes = "has Gmsh write the file";
const std::string changes = "has Gmsh make, change or remove files";

INSTANTIATE_TEST_SUITE_P(
    All, Attacks,
    testing::Values(
        Attack{"SystemCall", "SystemCall \"touch @/trace\";", command},
        Attack{"InACommentOfASkippedPart",
               "If(0)\n\" // \" /*\nEndIf\nSystemCall \"touch @/trace\";\nIf(0)\n*/\nEndIf",
               command},
        Attack{"NonBlockingSystemCall", "NonBlockingSystemCall \"touch @/trace\";", command},
        Attack{"OnelabRun", "OnelabRun(\"a\", \"touch @/trace\");", ""},
        Attack{"MergeOfCommands", "Merge \"evil.txt\";", command},
        Attack{"BackgroundMesh", "Merge \"evil.txt\"; Background Mesh View[0];", command},
        Attack{"ExternalProcess",
               "Field[1]=ExternalProcess; Field[1].CommandLine=\"touch @/trace\"; "
               "Background Field=1;",
               command},
        Attack{"Save", "Mesh 2; Save \"@/trace.msh\";", writes},
        Attack{"Print", "Mesh 2; Print \"@/trace.msh\";", writes},
        Attack{"Printf", "Printf(\"a\") > \"@/trace\";", writes},
        Attack{"PrintfAppends", "Printf(\"a\") >> \"@/canary\";", writes},
        Attack{"CreateDir", "CreateDir \"@/trace\";", changes},
        Attack{"RenameFile", "RenameFile {\"@/canary\", \"@/trace\"};", ""},
        Attack{"DeleteFile", "DeleteFile \"@/canary\";", ""},
        Attack{"WritingPlugin",
               "Plugin(NewView).Run; Plugin(ModifyComponents).Run; Save View [0] \"@/trace.pos\";",
               ""},
        Attack{"Fifo", "Field[1]=Structured; Field[1].FileName=\"@/fifo\"; Background Field=1;",
               "no regular file"},
        Attack{"Device", "Merge \"/dev/zero\";", "no regular file"},
        Attack{"Sleep", "Sleep 100000;", "has Gmsh wait"},
        Attack{"Threads", "General.NumThreads=100000;", "with General.NumThreads = 1"},
        Attack{"Exit", "Exit;", "ends Gmsh before there is a mesh"}),
    [](const auto& tested) { return tested.param.name; });

/// Messages about errors in Gmsh's language quote words of the file. An untrusted geometry can show
/// no more of a secret file than such words, and only to the user.
TEST_F(Attacks, ShowNoMoreThanWordsOfAFile) {
  const std::string secret = "first_word second_word third_word";
  folder_.write("secret", secret);
  const std::string message = refusal("Include \"@/secret\";");
  EXPECT_EQ(message.find(secret), std::string::npos) << message;
}

/// A number of threads that a machine may have is accepted.
TEST_F(Attacks, AreNotWhatAFileForManyProcessorsIs) {
  EXPECT_EQ(refusal("General.NumThreads=4; Mesh.MaxNumThreads2D=4;"), "");
}

}  // namespace geometry_attacks_test
}  // namespace suffuse
