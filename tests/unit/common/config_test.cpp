#include "common/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/car.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hairpin {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// All problems of `text` when `read` reads it; empty if there are none.
template <class Read>
std::string ProblemsOf(const std::string& text, Read read) {
  try {
    const Config config = Config::FromText(text, "test.yaml");
    read(config);
    config.Finish();
    return {};
  } catch (const ConfigError& error) {
    return error.what();
  }
}

const auto kReadGate = [](const Config& config) { config.Number("gate_m", {0.1, 10.0}); };

TEST(Config, ReadsEveryType) {
  const Config config =
      Config::FromText("a: 1.5\nb: 3\nc: true\nd: text\ne: [1, 2.5]\nf:\n  g: 7\n", "test.yaml");
  EXPECT_EQ(config.Number("a", {}), 1.5);
  EXPECT_EQ(config.Integer("b", 0, 10), 3);
  EXPECT_TRUE(config.Flag("c"));
  EXPECT_EQ(config.Text("d"), "text");
  EXPECT_THAT(config.Numbers("e", 2, {}), testing::ElementsAre(1.0, 2.5));
  EXPECT_EQ(config.Section("f").Number("g", {}), 7.0);
  EXPECT_TRUE(config.Has("a"));
  EXPECT_FALSE(config.Has("z"));
  EXPECT_NO_THROW(config.Finish());
}

TEST(Config, NamesFileLineKeyValueAndRuleOfAValueOutOfRange) {
  EXPECT_EQ(ProblemsOf("\ngate_m: 11\n", kReadGate),
            "test.yaml:2: gate_m: `11` must be from 0.1 to 10");
  EXPECT_EQ(ProblemsOf("gate_m: 10", kReadGate), "") << "the bounds belong to the range";
}

TEST(Config, RefusesAMissingKey) {
  EXPECT_THAT(ProblemsOf("{}", kReadGate), HasSubstr("gate_m: is missing"));
}

TEST(Config, RefusesAnUnknownKeyAndGuessesWhatWasMeant) {
  EXPECT_THAT(
      ProblemsOf("gate_m: 1\ngatem: 2\n", kReadGate),
      AllOf(HasSubstr("test.yaml:2: gatem: unknown key"), HasSubstr("did you mean gate_m?")));
  EXPECT_THAT(ProblemsOf("gate_m: 1\ncolour: 2\n", kReadGate),
              AllOf(HasSubstr("unknown key"), Not(HasSubstr("did you mean"))));
}

TEST(Config, RefusesADuplicateKey) {
  EXPECT_THAT(ProblemsOf("gate_m: 1\ngate_m: 2\n", kReadGate),
              HasSubstr("test.yaml:2: gate_m: stands twice"));
}

TEST(Config, RefusesNumbersThatAreNone) {
  for (const char* value :
       {"text", "1.0 m", "[1]", "{a: 1}", "", ".nan", ".inf", "-.inf", "true", "1,5", "1e999"}) {
    EXPECT_THAT(ProblemsOf(std::string("gate_m: ") + value, kReadGate),
                HasSubstr("is no finite number"))
        << value;
  }
}

TEST(Config, RefusesIntegersFlagsAndTextsThatAreNone) {
  const auto integer = [](const Config& config) { config.Integer("n", 1, 5); };
  for (const char* value : {"1.5", "two", "1e2", "99999999999", "[1]"}) {
    EXPECT_THAT(ProblemsOf(std::string("n: ") + value, integer), HasSubstr("is no integer"))
        << value;
  }
  EXPECT_THAT(ProblemsOf("n: 6", integer), HasSubstr("must be from 1 to 5"));
  EXPECT_THAT(ProblemsOf("n: 1", [](const Config& c) { c.Flag("n"); }),
              HasSubstr("neither true nor false"));
  EXPECT_THAT(ProblemsOf("n: [a]", [](const Config& c) { c.Text("n"); }), HasSubstr("is no text"));
}

TEST(Config, RefusesListsOfTheWrongSizeOrContent) {
  const auto pair = [](const Config& config) {
    EXPECT_EQ(config.Numbers("p", 2, {-1.0, 1.0}).size(), 2u);
  };
  EXPECT_EQ(ProblemsOf("p: [0, 1]", pair), "");
  for (const char* value : {"[]", "[1]", "[0, 0, 0]", "0.5", "{a: 1}"}) {
    EXPECT_THAT(ProblemsOf(std::string("p: ") + value, pair),
                HasSubstr("must be a list of 2 numbers"))
        << value;
  }
  EXPECT_THAT(ProblemsOf("p: [0, 2]", pair), HasSubstr("p[1]: `2` must be a number from -1 to 1"));
  EXPECT_THAT(ProblemsOf("p: [0, .nan]", pair), HasSubstr("p[1]"));
  const auto any = [](const Config& config) { config.Numbers("p", 0, {}); };
  EXPECT_EQ(ProblemsOf("p: [1, 2, 3]", any), "");
  EXPECT_THAT(ProblemsOf("p: []", any), HasSubstr("at least one"));
}

TEST(Config, NamesKeysOfSectionsByTheirPath) {
  const auto read = [](const Config& config) {
    config.Section("lidar").Number("sigma_m", {0.0, 1.0});
  };
  EXPECT_EQ(ProblemsOf("lidar:\n  sigma_m: 0.1\n", read), "");
  EXPECT_THAT(ProblemsOf("lidar:\n  sigma_m: 2\n", read), HasSubstr("test.yaml:2: lidar.sigma_m"));
  EXPECT_THAT(ProblemsOf("lidar:\n  sigma_m: 0.1\n  simga_m: 1\n", read),
              HasSubstr("lidar.simga_m: unknown key (did you mean sigma_m?)"));
}

TEST(Config, RefusesASectionThatIsMissingOrNone) {
  const auto read = [](const Config& config) {
    config.Section("lidar").Number("sigma_m", {0.0, 1.0});
  };
  EXPECT_THAT(ProblemsOf("{}", read), HasSubstr("test.yaml:1: lidar: is missing"));
  EXPECT_THAT(ProblemsOf("\nlidar: 3\n", read), HasSubstr("test.yaml:2: lidar: `3` is no section"));
  EXPECT_THAT(ProblemsOf("\nlidar:\n", read),
              HasSubstr("test.yaml:2: lidar: nothing is no section"));
}

TEST(Config, TellsAllProblemsAtOnce) {
  const std::string problems = ProblemsOf("a: 11\nb: x\nd: 1\n", [](const Config& config) {
    config.Number("a", {0.0, 10.0});
    config.Integer("b", 0, 1);
    config.Flag("c");
  });
  EXPECT_EQ(std::count(problems.begin(), problems.end(), '\n'), 3);
  EXPECT_THAT(problems, AllOf(HasSubstr("a: `11`"), HasSubstr("b: `x`"), HasSubstr("c: is missing"),
                              HasSubstr("d: unknown key")));
}

TEST(Config, GoesOnWithAValueInRangeAfterAProblem) {
  const Config config = Config::FromText("a: 99\n", "test.yaml");
  EXPECT_EQ(config.Number("a", {1.0, 2.0}), 1.0);
  EXPECT_EQ(config.Number("missing", {-5.0, -3.0}), -5.0);
  EXPECT_EQ(config.Integer("missing", 4, 9), 4);
  EXPECT_THAT(config.Numbers("missing", 3, {1.0, 2.0}), testing::ElementsAre(1.0, 1.0, 1.0));
}

TEST(Config, RefusesKeysThatAreNone) {
  EXPECT_THAT(ProblemsOf("gate_m: 1\n[x]: 1\n", kReadGate),
              HasSubstr("test.yaml:2: a list is no key"));
  EXPECT_THAT(ProblemsOf("gate_m: 1\n{x: 1}: 1\n", kReadGate), HasSubstr("a section is no key"));
}

TEST(Config, RefusesWhatIsNoYamlOrNoMapping) {
  for (const char* text :
       {"", "just text", "[1, 2]", "a: [1, 2", "a: b: c", "\t- x", "a: 1\n---\nb: 2\n"}) {
    EXPECT_THROW(Config::FromText(text, "test.yaml"), ConfigError) << text;
  }
  EXPECT_THROW(Config::Load("/nowhere", "watchdog"), ConfigError);
}

class ConfigOnDisk : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(directory_ + "/" + name + ".yaml") << text;
  }

  TemporaryFolder folder_;
  std::string directory_ = folder_.path();
};

TEST_F(ConfigOnDisk, TakesOverridesOfKeysThatTheFileHas) {
  Write("test", "a: 1\nb:\n  c: 2\nd: [1, 2]\n");
  const Config config = Config::Load(directory_, "test", {"a=5", "b.c=6", "d=[3, 4]"});
  EXPECT_EQ(config.Number("a", {}), 5.0);
  EXPECT_EQ(config.Section("b").Number("c", {}), 6.0);
  EXPECT_THAT(config.Numbers("d", 2, {}), testing::ElementsAre(3.0, 4.0));
}

TEST_F(ConfigOnDisk, RefusesOverridesOfWhatTheFileHasNot) {
  Write("test", "a: 1\nb:\n  c: 2\n");
  for (const char* assignment : {"z=1", "b.z=1", "a.c=1", "a", "=1", "a=[1"}) {
    EXPECT_THROW(Config::Load(directory_, "test", {assignment}), ConfigError) << assignment;
  }
}

TEST_F(ConfigOnDisk, ChecksAnOverriddenValueLikeAnyOther) {
  Write("test", "gate_m: 1\n");
  const Config config = Config::Load(directory_, "test", {"gate_m=99"});
  kReadGate(config);
  EXPECT_THROW(config.Finish(), ConfigError);
}

TEST_F(ConfigOnDisk, ReportsASiblingsProblemsWithItsOwn) {
  Write("test", "a: 99\n");
  Write("car", "mass_kg: 1\nmass_kgs: 2\n");
  const Config config = Config::Load(directory_, "test");
  config.Number("a", {0.0, 1.0});
  config.Sibling("car").Number("mass_kg", {50.0, 1000.0});
  try {
    config.Finish();
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("test.yaml:1: a"), HasSubstr("car.yaml:1: mass_kg"),
                                    HasSubstr("car.yaml:2: mass_kgs: unknown key")));
  }
  EXPECT_THROW(config.Sibling("nobody"), ConfigError);
}

TEST(Car, OfTheConfigIsTaken) {
  const Config config = Config::FromText("{}", "test.yaml", HAIRPIN_SOURCE_DIR "/config");
  const Car car = LoadCar(config);
  EXPECT_NO_THROW(config.Finish());
  EXPECT_NEAR(car.wheelbase(), 1.53, 1e-9);
  EXPECT_EQ(car.wheel_positions()[0], Eigen::Vector2d(car.front_axle, 0.5 * car.track_width));
  EXPECT_EQ(car.wheel_positions()[3], Eigen::Vector2d(-car.rear_axle, -0.5 * car.track_width));
}

TEST(Nearest, FindsASlipOfThePenAndNoMore) {
  EXPECT_EQ(Nearest("cluster_tolerence_m", {"ground_m", "cluster_tolerance_m"}),
            "cluster_tolerance_m");
  EXPECT_THAT(Nearest("colour", {"gate_m", "sigma_m"}), IsEmpty());
  EXPECT_THAT(Nearest("x", {}), IsEmpty());
}

}  // namespace
}  // namespace hairpin
