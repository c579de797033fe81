// Image files for tests.
#pragma once

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace keyhole {

// An image file that lives as long as this object; rows from the top. Its name has a space in it.
class ImageOnDisk {
  public:
    template <class T>
    ImageOnDisk(const std::string& extension, OIIO::TypeDesc type, int width, int height, int channels,
                const std::vector<T>& values, const std::vector<std::string>& channel_names = {}) {
        static int count = 0;
        const std::string name = "keyhole " + std::to_string(getpid()) + "-" + std::to_string(++count) + extension;
        path_ = (std::filesystem::temp_directory_path() / name).string();
        OIIO::ImageSpec spec(width, height, channels, type);
        if (!channel_names.empty()) spec.channelnames = channel_names;
        spec.attribute("oiio:UnassociatedAlpha", 1);
        const auto output = OIIO::ImageOutput::create(path_);
        EXPECT_TRUE(output && output->open(path_, spec) && output->write_image(type, values.data()) && output->close());
    }
    ~ImageOnDisk() { std::filesystem::remove(path_); }
    ImageOnDisk(const ImageOnDisk&) = delete;
    ImageOnDisk& operator=(const ImageOnDisk&) = delete;

    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace keyhole
