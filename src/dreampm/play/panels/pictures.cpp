#include "dreampm/play/panels/pictures.h"

#include <epoxy/gl.h>

#include "dreampm/io/png.h"
#include "dreampm/play/model/story_files.h"

namespace dreampm::play {

Pictures::Pictures() {
  for (const PictureFile& file : picture_files()) {
    const RgbImage image = decode_png({reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()},
                                      std::string(file.name) + ".png");
    Picture picture{0, image.width, image.height};
    glGenTextures(1, &picture.texture);
    glBindTexture(GL_TEXTURE_2D, picture.texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 image.pixels.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    all_.emplace(file.name, picture);
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glBindTexture(GL_TEXTURE_2D, 0);
}

Pictures::~Pictures() {
  for (const auto& [name, picture] : all_) glDeleteTextures(1, &picture.texture);
}

const Pictures::Picture* Pictures::find(std::string_view name) const {
  const auto found = all_.find(name);
  return found == all_.end() ? nullptr : &found->second;
}

}  // namespace dreampm::play
