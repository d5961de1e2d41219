// The actions of a plan, as a farm runs them: each with what it declares and nothing else, in other folders,
// by other users, in other languages, in other orders.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "processes.h"
#include "random_gltf.h"
#include "sandbox.h"

namespace lacquer::test::farm_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

Words wordsOf(const Json& list) { return list.get<Words>(); }

class Farm : public testing::Test {
protected:
  void SetUp() override {
    root_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    folder_ = root_ / "two" / "below";
    fs::create_directories(folder_);
    writeText(folder_ / "a b.gltf", RandomGltf(1).text(3));
    writeText(folder_ / "c.gltf", RandomGltf(2).text(3));
    // Further up than a worker's folder need lie deep.
    writeText(root_ / "far.gltf", RandomGltf(3).text(1));
    const Words common{"a b.gltf", "c.gltf", "../../far.gltf", "-q", "--no-sync"};
    Words plan{LACQUER_PROGRAM, "plan", "--ninja", "build.ninja", "--json", "actions.json", "-o", "out"};
    Words gen{LACQUER_PROGRAM, "gen", "-o", "local"};
    plan.insert(plan.end(), common.begin(), common.end());
    gen.insert(gen.end(), common.begin(), common.end());
    ASSERT_EQ(runProgram(plan, folder_), 0);
    ASSERT_EQ(runProgram(gen, folder_), 0);
    actions_ = Json::parse(readText(folder_ / "actions.json"))["actions"];
    ASSERT_GT(actions_.size(), 3U);
  }
  void TearDown() override { fs::remove_all(root_.parent_path()); }

  /// An empty folder that holds the inputs of an action that are relative, copied from the first store.
  fs::path workplace(const std::string& name, const Json& action) const {
    const fs::path place = folder_ / name;
    fs::remove_all(place);
    for (const std::string& input : wordsOf(action["inputs"])) {
      if (fs::path(input).is_absolute()) continue;
      fs::create_directories((place / input).parent_path());
      fs::copy_file(folder_ / input, place / input);
    }
    for (const std::string& output : wordsOf(action["outputs"]))
      fs::create_directories((place / output).parent_path());
    return place;
  }

  /// Brings what an action has declared back; what it wrote beside that is an error.
  void deliver(const fs::path& place, const Json& action) const {
    Words declared = wordsOf(action["outputs"]);
    for (const auto& [name, state] : filesBelow(place)) {
      const Words inputs = wordsOf(action["inputs"]);
      if (std::find(inputs.begin(), inputs.end(), name) != inputs.end()) continue;
      EXPECT_NE(std::find(declared.begin(), declared.end(), name), declared.end())
          << action["name"] << " writes " << name << ", which it does not declare";
    }
    for (const std::string& output : declared) {
      ASSERT_TRUE(fs::exists(place / output)) << action["name"] << " does not write " << output;
      fs::create_directories((folder_ / output).parent_path());
      fs::copy_file(place / output, folder_ / output, fs::copy_options::overwrite_existing);
    }
  }

  /// The command in front of an action's own, in its folder.
  void runAll(const std::function<Words(const fs::path&, const Json&)>& around, bool backwards = false) {
    std::vector<Json> shaders(actions_.begin(), actions_.end() - 1);
    if (backwards) std::reverse(shaders.begin(), shaders.end());
    shaders.push_back(actions_.back());
    for (const Json& action : shaders) {
      EXPECT_EQ(action["environment"], Json::object());
      const fs::path place = workplace("work", action);
      Words words = around(place, action);
      const Words command = wordsOf(action["command"]);
      words.insert(words.end(), command.begin(), command.end());
      std::string output;
      ASSERT_EQ(runProgram(words, place, &output), 0) << action["name"] << ": " << output;
      deliver(place, action);
    }
    EXPECT_EQ(differences(folder_ / "local", folder_ / "out"), "");
  }

  fs::path root_, folder_;
  Json actions_;
};

TEST_F(Farm, ActionsAreHermetic) {
  const Sandbox sandbox(folder_ / "sandbox", Clock::Still);
  if (!sandbox.works())
    GTEST_SKIP() << "NOT TESTED: bubblewrap cannot make a sandbox here: " << sandbox.why();
  runAll([&](const fs::path& place, const Json& action) {
    return sandbox.around(place, wordsOf(action["inputs"]));
  });
  // The sandbox holds: with an input less, the action fails.
  const fs::path place = workplace("poor", actions_[0]);
  fs::remove_all(place / "build.ninja.plan");
  Words words = sandbox.around(place, {LACQUER_PROGRAM});
  const Words command = wordsOf(actions_[0]["command"]);
  words.insert(words.end(), command.begin(), command.end());
  std::string output;
  EXPECT_NE(runProgram(words, folder_, &output), 0);
}

/// What was asked of the sandbox is so, as a program in it sees it.
TEST_F(Farm, TheSandboxHasNoClockHomeNorNetwork) {
  const Sandbox sandbox(folder_ / "sandbox", Clock::Still);
  if (!sandbox.works())
    GTEST_SKIP() << "NOT TESTED: bubblewrap cannot make a sandbox here: " << sandbox.why();
  const fs::path place = folder_ / "look";
  fs::create_directories(place);
  const auto says = [&](const std::string& command) {
    Words words = sandbox.around(place, {});
    words.insert(words.end(), {"/bin/sh", "-c", command});
    std::string output;
    runProgram(words, folder_, &output);
    return output;
  };
  EXPECT_EQ(says("ls /"), "bin\ndev\netc\nlib\nlib64\nplace\ntmp\nusr\n");
  EXPECT_EQ(says("/usr/bin/env"), "PWD=/place\n");  // which the shell has set
  EXPECT_EQ(says("/usr/bin/id -u; /usr/bin/id -g; /bin/uname -n"), "4321\n1234\nelsewhere\n");
  EXPECT_EQ(says("echo x > /usr/x || echo no"),
            "/bin/sh: 1: cannot create /usr/x: Read-only file system\nno\n");
  EXPECT_EQ(says("/bin/date +%s.%N"), "0.000000000\n");
  if (fs::exists("/usr/bin/python3")) {
    EXPECT_EQ(says("/usr/bin/python3 -c 'import time; print(time.time(), time.monotonic())'"), "0.0 0.0\n");
    // Not by the kernel either: 38 is ENOSYS.
    EXPECT_EQ(
        says("/usr/bin/python3 -c 'import ctypes, sys; c = ctypes.CDLL(None, use_errno=True); "
             "print(c.syscall(int(sys.argv[1]), 0, ctypes.create_string_buffer(64)), ctypes.get_errno())' " +
             std::to_string(Sandbox::clockCall())),
        "-1 38\n");
    EXPECT_NE(says("/usr/bin/python3 -c 'import socket; socket.create_connection((\"192.0.2.1\", 80), 1)'")
                  .find("Network is unreachable"),
              std::string::npos);
  }
}

/// Each look at the clock finds another year.
TEST_F(Farm, WildClocksGiveTheSameBytes) {
  const Sandbox sandbox(folder_ / "sandbox", Clock::Wild);
  if (!sandbox.works())
    GTEST_SKIP() << "NOT TESTED: bubblewrap cannot make a sandbox here: " << sandbox.why();
  Words look = sandbox.around(folder_, {});
  look.insert(look.end(), {"/bin/date", "+%s"});
  std::string one, two;
  ASSERT_EQ(runProgram(look, folder_, &one), 0);
  ASSERT_EQ(runProgram(look, folder_, &two), 0);
  ASSERT_NE(one, two);
  runAll([&](const fs::path& place, const Json& action) {
    return sandbox.around(place, wordsOf(action["inputs"]));
  });
}

TEST_F(Farm, OtherFoldersLanguagesAndOrdersGiveTheSameBytes) {
  runAll(
      [](const fs::path&, const Json&) {
        return Words{
            "/usr/bin/env",  "-i",         "LC_ALL=tr_TR.UTF-8", "LANG=de_DE.UTF-8", "TZ=Pacific/Chatham",
            "HOME=/nowhere", "USER=nobody"};
      },
      true);
}

TEST_F(Farm, AnotherUserGivesTheSameBytes) {
  std::string output;
  const Words as_nobody{"/usr/bin/env", "setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"};
  Words probe = as_nobody;
  probe.insert(probe.end(), {LACQUER_PROGRAM, "--version"});
  if (runProgram(probe, folder_, &output) != 0)
    GTEST_SKIP() << "NOT TESTED: nobody cannot run the program here: " << output;
  runAll([&](const fs::path& place, const Json&) {
    for (const auto& entry : fs::recursive_directory_iterator(place)) {
      if (entry.is_directory()) fs::permissions(entry.path(), fs::perms::all);
    }
    fs::permissions(place, fs::perms::all);
    return as_nobody;
  });
}

/// The JSON and the Ninja file say the same.
TEST_F(Farm, ActionsAreThoseOfTheNinjaFile) {
  std::string commands;
  if (runProgram({"/usr/bin/env", "ninja", "-f", "build.ninja", "-t", "commands"}, folder_, &commands) != 0)
    GTEST_SKIP() << "NOT TESTED: there is no ninja";
  EXPECT_EQ(static_cast<size_t>(std::count(commands.begin(), commands.end(), '\n')), actions_.size());
  for (const Json& action : actions_) {
    std::string line;
    for (const std::string& word : wordsOf(action["command"])) line += (line.empty() ? "" : " ") + word;
    EXPECT_NE(commands.find(line), std::string::npos) << line;
  }
}

// -- Slurm, by a stand-in for its sbatch --

/// Runs an array job at once, the tasks backwards, and refuses what a real one does.
constexpr const char* kSbatch = R"py(#!/usr/bin/env python3
import os, re, subprocess, sys
options = dict(re.fullmatch(r"--([a-z-]+)(?:=(.*))?", word).groups() for word in sys.argv[1:])
assert set(options) <= {"parsable", "array", "job-name", "dependency", "kill-on-invalid-dep"}, options
job = 1 + len([name for name in os.listdir(".") if name.startswith("job-")])
if "dependency" in options:
    done = re.fullmatch(r"afterok:([0-9]+)", options["dependency"])[1]
    assert open(f"job-{done}").read() == "0", "what it depends on has failed"
first, last = map(int, options["array"].split("-"))
script = sys.stdin.read()
assert script.startswith("#!/bin/sh\n")
failed = 0
for task in range(last, first - 1, -1):
    environment = {**os.environ, "SLURM_ARRAY_TASK_ID": str(task), "LC_ALL": "tr_TR.UTF-8", "TZ": "Pacific/Chatham"}
    failed |= subprocess.run(["/bin/sh", "-c", script], env=environment).returncode != 0
open(f"job-{job}", "w").write(str(int(failed)))
print(f"{job};cluster")
)py";

class Slurm : public Farm {
protected:
  int submit(const Words& more, std::string* output) const {
    writeText(folder_ / "bin" / "sbatch", kSbatch);
    fs::permissions(folder_ / "bin" / "sbatch", fs::perms::owner_all);
    const char* path = std::getenv("PATH");
    Words words{"/usr/bin/env",
                "PATH=" + (folder_ / "bin").string() + ":" + (path == nullptr ? "/usr/bin:/bin" : path),
                "python3",
                std::string(LACQUER_SOURCE) + "/examples/slurm/farm.py",
                "submit",
                "actions.json"};
    words.insert(words.end(), more.begin(), more.end());
    return runProgram(words, folder_, output);
  }
  void SetUp() override {
    Farm::SetUp();
    fs::create_directories(folder_ / "bin");
  }
  void writeActions() const { writeText(folder_ / "actions.json", Json{{"actions", actions_}}.dump()); }
};

TEST_F(Slurm, AnArrayJobMakesTheSameBytes) {
  std::string output;
  ASSERT_EQ(submit({"--tasks", "3"}, &output), 0) << output;
  const std::string shaders = std::to_string(actions_.size() - 1);
  EXPECT_EQ(output,
            "stage 0: " + shaders + " actions in 3 tasks, job 1\nstage 1: 1 actions in 1 tasks, job 2\n");
  EXPECT_EQ(differences(folder_ / "local", folder_ / "out"), "");
}

/// What an action declares is what it has, and what it must do.
TEST_F(Slurm, WhatIsNotDeclaredFails) {
  const Json all = actions_;
  std::string output;
  actions_ = Json::array({all[0]});
  actions_[0]["inputs"].erase(1);
  writeActions();
  EXPECT_NE(submit({}, &output), -1);
  EXPECT_EQ(readText(folder_ / "job-1"), "1") << output;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  actions_ = Json::array({all[0]});
  const std::string last = actions_[0]["outputs"].back();
  actions_[0]["outputs"].erase(actions_[0]["outputs"].size() - 1);
  writeActions();
  submit({}, &output);
  EXPECT_EQ(readText(folder_ / "job-2"), "1") << output;
  EXPECT_NE(output.find("writes ['" + last + "'] undeclared"), std::string::npos) << output;
  // What depends on a job that failed is refused.
  actions_ = all;
  actions_[0]["command"][0] = "/bin/false";
  writeActions();
  EXPECT_NE(submit({}, &output), 0);
  EXPECT_FALSE(fs::exists(folder_ / "out" / "manifest.json"));
}

/// Names of folders and files are no words of the job's script.
TEST_F(Farm, NamesGoThroughNoShell) {
  const std::string name = "x'$(touch strange)'`touch strange`; touch strange #.json";
  fs::copy_file(folder_ / "actions.json", folder_ / name);
  fs::create_directories(folder_ / "bin");
  writeText(folder_ / "bin/sbatch",
            "#!/bin/sh\ncat > job.sh\nSLURM_ARRAY_TASK_ID=0 sh job.sh 2>&1\necho 1\n");
  fs::permissions(folder_ / "bin/sbatch", fs::perms::owner_all);
  const std::string farm = std::string(LACQUER_SOURCE) + "/examples/slurm/farm.py";
  std::string said;
  runProgram({"sh", "-c", "PATH=\"$PWD/bin:$PATH\" exec python3 \"$@\"", "sh", farm, "submit", name,
              "--scratch", "no '$(touch strange)' folder"},
             folder_, &said);
  EXPECT_NE(readText(folder_ / "job.sh").find("farm.py"), std::string::npos) << said;
  EXPECT_FALSE(fs::exists(folder_ / "strange")) << readText(folder_ / "job.sh");
}

}  // namespace
}  // namespace lacquer::test::farm_test
