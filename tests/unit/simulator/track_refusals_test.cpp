#include <gmock/gmock.h>

#include "tests/unit/simulator/track_testing.hpp"

namespace hairpin {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// One change to a good file, and what must be said of it at the line of `at` (in the changed
/// text).
struct Change {
  const char* name;
  const char* fixture;
  const char* from;
  const char* to;
  const char* at;
  const char* reason;
};

constexpr const char* kOwn = "oval_hairpin.yaml";
constexpr const char* kPacsim = "oval_pacsim.yaml";
constexpr const char* kFssim = "oval_fssim.yaml";
constexpr const char* kEufs = "oval_eufs.csv";

class TrackRefusal : public ::testing::TestWithParam<Change> {};

TEST_P(TrackRefusal, NamesLineAndReason) {
  const Change& change = GetParam();
  const std::string good = TextOf(Fixture(change.fixture));
  const std::string text = Replaced(good, change.from, change.to);
  const std::string extension = std::filesystem::path(change.fixture).extension();
  ASSERT_EQ(RefusalOf(good, extension), "");
  EXPECT_THAT(
      RefusalOf(text, extension),
      AllOf(StartsWith(std::to_string(LineOf(text, change.at)) + ": "), HasSubstr(change.reason)));
}

INSTANTIATE_TEST_SUITE_P(
    Own, TrackRefusal,
    ::testing::Values(
        Change{"NoSuchKey", kOwn,
               "others:", "otters:", "otters:", "no such key: otters; did you mean others?"},
        Change{"KeyTwice", kOwn, "closed: true", "closed: true\nclosed: true",
               "closed: true\nstart", "stands twice"},
        Change{"MissingKey", kOwn, "start: {x_m: 0, y_m: 0, yaw_rad: 0}\n", "", "# A small",
               "no key start"},
        Change{"OriginOffTheEarth", kOwn, "closed: true",
               "origin: {latitude_deg: 95, longitude_deg: 8, height_m: 400}\nclosed: true",
               "origin", "is no place on Earth"},
        Change{"WrongVersion", kOwn, "hairpin_track: 1", "hairpin_track: 2", "hairpin_track",
               "version"},
        Change{"WrongType", kOwn, "x_m: 13, y_m: 2.8", "x_m: far, y_m: 2.8", "far",
               "x_m must be a finite number, not `far`"},
        Change{"NumberWithATail", kOwn, "x_m: 13, y_m: 2.8", "x_m: 13m, y_m: 2.8", "13m",
               "must be a finite number"},
        Change{"NotANumber", kOwn, "x_m: 13, y_m: 2.8", "x_m: nan, y_m: 2.8", "nan",
               "must be a finite number"},
        Change{"YamlNotANumber", kOwn, "x_m: 13, y_m: 2.8", "x_m: .nan, y_m: 2.8", ".nan",
               "must be a finite number"},
        Change{"Infinite", kOwn, "x_m: 13, y_m: 2.8", "x_m: inf, y_m: 2.8", "inf",
               "must be a finite number"},
        Change{"OtherWorld", kOwn, "x_m: 13, y_m: 2.8", "x_m: 1e9, y_m: 2.8", "1e9",
               "must be a finite number"},
        Change{"FlagOfAnotherKind", kOwn, "closed: true", "closed: perhaps", "closed",
               "true or false"},
        Change{"ListForANumber", kOwn, "yaw_rad: 0", "yaw_rad: [0]", "start:", "not a list"},
        Change{"NoList", kOwn, "clutter:\n  - [0, 8]", "clutter: 7", "clutter", "must be a list"},
        Change{"ShortPoint", kOwn, "- [0, 8]", "- [8]", "- [8]", "2 to 3 numbers"},
        Change{"UnknownColour", kOwn, "y_m: 2.8, colour: blue", "y_m: 2.8, colour: mauve", "mauve",
               "no such colour: mauve"},
        Change{"BrokenYaml", kOwn, "x_m: 13, y_m: 2.8, colour: blue}",
               "x_m: 13, y_m: 2.8, colour: blue", "  - {x_m: 16,", "no YAML"},
        Change{"YellowOnTheLeft", kOwn, "y_m: 2.8, colour: blue", "y_m: 2.8, colour: yellow",
               "y_m: 2.8, colour: yellow", "yellow cone on the left side"},
        Change{"DoubledCone", kOwn, "{x_m: 13, y_m: 2.8,", "{x_m: 10.05, y_m: 2.05,", "10.05",
               "a cone stands here already at (10.00, 2.00)"},
        Change{"ConeBesideDoubled", kOwn, "{x_m: 6, y_m: 4,", "{x_m: 8.01, y_m: 2,", "8.01",
               "a cone stands here already"},
        Change{"SidesThatCross", kOwn, "{x_m: 16, y_m: 8,", "{x_m: 21, y_m: 8,",
               "{x_m: 15.2, y_m: 5,", "left side crosses the right side"},
        Change{"SideThatCrossesItself", kOwn, "{x_m: 7, y_m: 14,", "{x_m: 2, y_m: 14,",
               "{x_m: 3.5, y_m: 14", "left side crosses itself"},
        Change{"Narrow", kOwn, "{x_m: 0, y_m: 14,", "{x_m: 0, y_m: 16.5,", "y_m: 16.5",
               "less than 2.00 m"},
        Change{"LineBesideTheTrack", kOwn, "right_m: [6, -2]", "right_m: [6, 8]", "start_line",
               "the start line does not lie across the track"},
        Change{"StartOutside", kOwn, "start: {x_m: 0, y_m: 0,", "start: {x_m: 0, y_m: 7,",
               "start:", "the start is outside the track"},
        Change{"StartBackwards", kOwn, "yaw_rad: 0}", "yaw_rad: 3.14}",
               "start:", "wrong direction"},
        Change{"LineOffTheSide", kOwn, "left_m: [6, 2]", "left_m: [6, 4]", "start_line",
               "does not end on the left side"},
        Change{"SidesBeginElsewhere", kOwn, "start_line: {left_m: [6, 2], right_m: [6, -2]}",
               "start_line: {left_m: [-2, 2], right_m: [-2, -2]}", "start_line",
               "between its last and first cone"},
        Change{"FinishOfALap", kOwn, "left:\n",
               "finish_line: {left_m: [0, 2], right_m: [0, -2]}\nleft:\n", "finish_line",
               "finishes at its start line"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Foreign, TrackRefusal,
    ::testing::Values(
        Change{"PacsimUnknownClass", kPacsim, "class: yellow", "class: lemon", "class: lemon",
               "unknown class: lemon"},
        Change{"PacsimMissingSide", kPacsim, "  right:", "  wrong:", "track:", "no key right"},
        Change{"PacsimNotANumber", kPacsim, "[10, 2, 0.0]", "[nan, 2, 0.0]", "[nan",
               "must be a finite number"},
        Change{"PacsimOddPosts", kPacsim,
               "  - position: [6.0, -5.0, 0.0]\n    class: timekeeping\n", "", "time_keeping",
               "pairs"},
        Change{"PacsimLineThatMissesASide", kPacsim, "[6.0, 5.0, 0.0]", "[60.0, -5.0, 0.0]",
               "[6.0, -5.0", "the line across the track does not reach"},
        Change{"PacsimGap", kPacsim,
               "  - position: [3.5, 14, 0.0]\n    class: blue\n  - position: [0, 14, 0.0]\n    "
               "class: blue\n",
               "", "[7, 14", "10.50 m away, more than 10.00 m"},
        Change{"PacsimBlueOnTheRight", kPacsim, "orientation: [0.0, 0.0, 0.0]",
               "orientation: [0.0, 0.0, 3.1]",
               "start:", "wrong direction: the left side is not on the left hand"},
        Change{"FssimShortPose", kFssim, "starting_pose_front_wing:\n- 0.0\n",
               "starting_pose_front_wing:\n", "starting_pose", "a list of 3 numbers"},
        Change{"FssimOneDevice", kFssim, "- - 6.0\n  - 3.0\n", "", "tk_device", "two posts"},
        Change{"EufsUnknownTag", kEufs, "yellow,", "green,", "green,", "unknown tag: green"},
        Change{"EufsNotANumber", kEufs, "car_start,0,0", "car_start,nan,0", "car_start",
               "x must be a finite number, not `nan`"},
        Change{"EufsShortRow", kEufs, "car_start,0,0,0,0,0,0", "car_start,0,0", "car_start",
               "a row must have at least"},
        Change{"EufsNoStart", kEufs, "car_start,0,0,0,0,0,0\n", "", "tag,", "no row car_start"},
        Change{"EufsTwoStarts", kEufs, "car_start,0,0,0,0,0,0\n",
               "car_start,0,0,0,0,0,0\ncar_start,0,0,0,0,0,1\n", "0,0,1", "car_start stands twice"},
        Change{"EufsOtherHeading", kEufs, "tag,x,y,direction", "tag,y,x,direction", "tag,",
               "the heading must begin with"}),
    [](const auto& test) { return test.param.name; });

TEST(TrackRefusals, AFileThatCannotBeReadIsNamed) {
  for (const std::string file : {"/nonexistent/track.yaml", "/tmp"}) {
    try {
      LoadTrack(file);
      ADD_FAILURE() << file;
    } catch (const TrackError& error) {
      EXPECT_THAT(error.what(), StartsWith(file + ":1: cannot be read"));
    }
  }
}

TEST(TrackRefusals, WhatIsNoTrackSaysWhichKeysWouldMakeItOne) {
  EXPECT_THAT(RefusalOf("car: fast\n"),
              AllOf(StartsWith("1: no track"), HasSubstr("hairpin_track")));
  EXPECT_THAT(RefusalOf("just words\n"), StartsWith("1: no track"));
  EXPECT_THAT(RefusalOf(""), StartsWith("1: cannot be read, or is empty"));
}

TEST(TrackRefusals, ASideWithoutConesOrWithTwoIsNamed) {
  const std::string good = TextOf(Fixture(kOwn));
  const size_t left = good.find("left:\n");
  const size_t right = good.find("right:\n");
  const std::string none = good.substr(0, left) + "left: []\n" + good.substr(right);
  EXPECT_THAT(RefusalOf(none), HasSubstr("no left side"));
  const std::string two =
      good.substr(0, left) +
      "left:\n  - {x_m: 8, y_m: 2, colour: blue}\n  - {x_m: 4, y_m: 2, colour: blue}\n" +
      good.substr(right);
  EXPECT_THAT(RefusalOf(two), AllOf(StartsWith(std::to_string(LineOf(two, "left:\n") + 1) + ": "),
                                    HasSubstr("left side has 2 cones, fewer than 3")));
}

TEST(TrackRefusals, ASideOutOfOrderIsNamed) {
  // Every cone where it was, but the list runs backwards from the start line.
  const std::string good = TextOf(Fixture(kOwn));
  const size_t begin = good.find("left:\n") + 6;
  const size_t end = good.find("right:\n");
  std::istringstream lines(good.substr(begin, end - begin));
  std::string reversed;
  for (std::string line; std::getline(lines, line);) reversed = line + "\n" + reversed;
  const std::string text = good.substr(0, begin) + reversed + good.substr(end);
  EXPECT_THAT(RefusalOf(text), HasSubstr("left side is not in driving order"));
}

}  // namespace
}  // namespace hairpin
