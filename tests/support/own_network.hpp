#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/process.hpp"

namespace hairpin {

inline constexpr const char* kInsideVariable = "HAIRPIN_TEST_IN_OWN_NETWORK";

/// True in the copy of the test that RunInOwnNetwork() has started.
inline bool InOwnNetwork() { return std::getenv(kInsideVariable) != nullptr; }

/// Runs the current test once more, in a network namespace of its own with a multicast route, so
/// that nothing reaches the host's network; skips it where the kernel grants none. A test begins
/// with `if (!InOwnNetwork()) return RunInOwnNetwork();`.
inline void RunInOwnNetwork() {
  if (Process({"unshare", "-Urn", "true"}).Wait(10'000) != 0)
    GTEST_SKIP() << "no network namespaces here";
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string filter =
      std::string("--gtest_filter=") + test->test_suite_name() + "." + test->name();
  Process inside({"unshare", "-Urn", "sh", "-c",
                  "ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec \"$0\" \"$1\"",
                  std::filesystem::read_symlink("/proc/self/exe"), filter},
                 {{kInsideVariable, "1"}});
  const std::optional<int> code = inside.Wait(60'000);
  ASSERT_TRUE(code) << "still running";
  EXPECT_EQ(*code, 0) << inside.Output();
}

}  // namespace hairpin
