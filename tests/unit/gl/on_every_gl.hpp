#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/gl/device.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace raytruth {

/// Tests of shaders, on every platform that comes up; where one does not, they are skipped and say what is missing.
class OnEveryGl : public testing::TestWithParam<GlPlatform> {
 protected:
  void SetUp() override {
    try {
      device = open_gl(GetParam());
    } catch (const MissingError& error) {
      GTEST_SKIP() << error.what();
    }
  }

  std::unique_ptr<GlDevice> device;
};

inline std::string platform_name(const testing::TestParamInfo<GlPlatform>& info) {
  switch (info.param) {
    case GlPlatform::osmesa:
      return "osmesa";
    case GlPlatform::egl_device:
      return "egl_device";
    default:
      return "egl_surfaceless";
  }
}

inline const auto every_gl_platform =
    testing::Values(GlPlatform::osmesa, GlPlatform::egl_device, GlPlatform::egl_surfaceless);

}  // namespace raytruth
