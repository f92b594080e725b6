// OpenGL's objects with owners: each is deleted with its C++ object. All need a current context of
// OpenGL 3.3, at their birth, use and end.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "dreampm/gl/camera.h"
#include "dreampm/math/vec.h"

namespace dreampm::gl {

/// Owns one OpenGL name; `Delete` gives it back.
template <void (*Delete)(unsigned)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(unsigned name) : name_(name) {}
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Handle() {
    if (name_ != 0) Delete(name_);
  }
  unsigned get() const { return name_; }

 private:
  unsigned name_ = 0;
};
void delete_buffer(unsigned name);
void delete_vertex_array(unsigned name);
void delete_texture(unsigned name);
void delete_framebuffer(unsigned name);
void delete_program(unsigned name);

/// Throws RunError naming `where` if OpenGL has noted an error since the last call.
void check_errors(std::string_view where);

/// Memory for vertices, indices or uniforms.
class Buffer {
 public:
  Buffer();
  unsigned name() const { return name_.get(); }
  /// Replaces the content; what a frame in flight still reads is left to it (orphaned), so that
  /// nobody waits.
  void fill(const void* data, std::size_t bytes);

 private:
  Handle<delete_buffer> name_;
  std::size_t capacity_ = 0;
};

/// Which buffers feed which inputs of a vertex shader.
class VertexArray {
 public:
  VertexArray();
  void bind() const;
  /// Input `index` takes `components` floats a vertex from the buffer, of which each `every`th is
  /// used.
  void floats(int index, const Buffer& buffer, int components, int every = 1);
  /// Input `index` takes four bytes a vertex, as numbers from 0 to 1.
  void bytes(int index, const Buffer& buffer);
  /// Input `index` is zero for every vertex.
  void none(int index);
  void indices(const Buffer& buffer);

 private:
  Handle<delete_vertex_array> name_;
};

/// What a texel holds.
enum class Texel { rgba8, rg8, r8, rgba16f, rgba32f, depth };

/// A 2D texture without mipmaps. Reading outside gives the texel at the edge.
class Texture {
 public:
  enum class Filter { nearest, linear };
  Texture(Texel texel, Filter filter);
  /// Makes it width x height; content is undefined afterwards. Does nothing where it is so already.
  void resize(int width, int height);
  unsigned name() const { return name_.get(); }
  int width() const { return width_; }
  int height() const { return height_; }
  bool is_depth() const { return texel_ == Texel::depth; }
  /// Depth only: whether texture() compares with the third coordinate (a sampler2DShadow).
  void compare(bool on);

 private:
  Handle<delete_texture> name_;
  Texel texel_;
  int width_ = 0, height_ = 0;
};

/// A framebuffer object over textures that outlive it, all of one size.
class Target {
 public:
  explicit Target(std::initializer_list<const Texture*> textures);
  /// Draws go here, over all of it. Throws RunError if the driver cannot draw into such textures.
  void bind() const;
  unsigned name() const { return name_.get(); }
  int width() const { return first_->width(); }
  int height() const { return first_->height(); }

 private:
  Handle<delete_framebuffer> name_;
  const Texture* first_;
};

/// A vertex shader and a fragment shader, linked.
class Program {
 public:
  /// Names of files in shaders/, without ".glsl". Throws RunError with the compiler's words, in
  /// which source numbers are replaced by file names; lines count within that file.
  Program(std::string_view vertex, std::string_view fragment);
  void use() const;
  /// Uniforms of the program in use; a name that the compiler has dropped is passed over.
  void set(const char* name, float value) const;
  void set(const char* name, int value) const;
  void set(const char* name, float x, float y) const;
  void set_pair(const char* name, int x, int y) const;  ///< an ivec2
  void set(const char* name, const Vec3f& value) const;
  void set(const char* name, const Vec3f& xyz, float w) const;
  void set(const char* name, const Mat4f& value) const;
  void set_array(const char* name, const Vec3f* values, int count) const;
  /// Texture unit `unit` (0 to 15) with this texture.
  void texture(const char* name, int unit, const Texture& texture) const;

 private:
  Handle<delete_program> name_;
};

/// One triangle over the whole target; the vertex shader is screen.vert.
class ScreenTriangle {
 public:
  void draw() const;

 private:
  VertexArray array_;
};

}  // namespace dreampm::gl
