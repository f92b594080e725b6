#include "dreampm/gl/objects.h"

#include <epoxy/gl.h>

#include "dreampm/base/error.h"
#include "dreampm/gl/shader_text.h"

namespace dreampm::gl {

void delete_buffer(unsigned name) { glDeleteBuffers(1, &name); }
void delete_vertex_array(unsigned name) { glDeleteVertexArrays(1, &name); }
void delete_texture(unsigned name) { glDeleteTextures(1, &name); }
void delete_framebuffer(unsigned name) { glDeleteFramebuffers(1, &name); }
void delete_program(unsigned name) { glDeleteProgram(name); }

namespace {

template <class Generate>
unsigned generated(const Generate& generate) {
  unsigned name = 0;
  generate(1, &name);
  return name;
}

struct TexelFormat {
  GLint internal;
  GLenum format, type;
};
TexelFormat format_of(Texel texel) {
  switch (texel) {
    case Texel::rgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case Texel::rg8:
      return {GL_RG8, GL_RG, GL_UNSIGNED_BYTE};
    case Texel::r8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE};
    case Texel::rgba16f:
      return {GL_RGBA16F, GL_RGBA, GL_FLOAT};
    case Texel::rgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case Texel::depth:
      break;
  }
  return {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT};
}

void compile(unsigned program, GLenum kind, std::string_view name) {
  const ShaderSource source = assemble_shader(name);
  const GLuint shader = glCreateShader(kind);
  const char* text = source.text.data();
  const GLint size = static_cast<GLint>(source.text.size());
  glShaderSource(shader, 1, &text, &size);
  glCompileShader(shader);
  GLint done = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (!done) {
    std::string log(8192, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    glDeleteShader(shader);
    fail_run("the shader {}.glsl does not compile:\n{}", name, with_file_names(log, source.files));
  }
  glAttachShader(program, shader);
  glDeleteShader(shader);  // with the program
}

}  // namespace

void check_errors(std::string_view where) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  while (glGetError() != GL_NO_ERROR) {
  }
  fail_run("{}: OpenGL {}", where,
           error == GL_OUT_OF_MEMORY ? std::string("is out of memory: draw fewer particles or a smaller picture")
                                     : fmt::format("refused a call (error 0x{:04x})", error));
}

Buffer::Buffer() : name_(generated(glGenBuffers)) {}

void Buffer::fill(const void* data, std::size_t bytes) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, name());
  if (bytes > capacity_) capacity_ = bytes + bytes / 4;
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(capacity_), nullptr, GL_STREAM_DRAW);
  glBufferSubData(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
}

VertexArray::VertexArray() : name_(generated(glGenVertexArrays)) {}

void VertexArray::bind() const { glBindVertexArray(name_.get()); }

void VertexArray::floats(int index, const Buffer& buffer, int components, int every) {
  bind();
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glEnableVertexAttribArray(static_cast<GLuint>(index));
  glVertexAttribPointer(static_cast<GLuint>(index), components, GL_FLOAT, GL_FALSE,
                        components * every * static_cast<int>(sizeof(float)), nullptr);
}

void VertexArray::bytes(int index, const Buffer& buffer) {
  bind();
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glEnableVertexAttribArray(static_cast<GLuint>(index));
  glVertexAttribPointer(static_cast<GLuint>(index), 4, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
}

void VertexArray::none(int index) {
  bind();
  glDisableVertexAttribArray(static_cast<GLuint>(index));
  glVertexAttrib4f(static_cast<GLuint>(index), 0, 0, 0, 0);
}

void VertexArray::indices(const Buffer& buffer) {
  bind();
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.name());
}

Texture::Texture(Texel texel, Filter filter) : name_(generated(glGenTextures)), texel_(texel) {
  glBindTexture(GL_TEXTURE_2D, name());
  const GLint how = filter == Filter::linear ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, how);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, how);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
}

void Texture::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  const TexelFormat f = format_of(texel_);
  glBindTexture(GL_TEXTURE_2D, name());
  glTexImage2D(GL_TEXTURE_2D, 0, f.internal, width, height, 0, f.format, f.type, nullptr);
  check_errors(fmt::format("a texture of {} x {} pixels", width, height));
  width_ = width;
  height_ = height;
}

void Texture::compare(bool on) {
  glBindTexture(GL_TEXTURE_2D, name());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, on ? GL_COMPARE_REF_TO_TEXTURE : GL_NONE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

Target::Target(std::initializer_list<const Texture*> textures)
    : name_(generated(glGenFramebuffers)), first_(*textures.begin()) {
  glBindFramebuffer(GL_FRAMEBUFFER, name());
  GLenum colors[8], count = 0;
  for (const Texture* texture : textures) {
    const GLenum at = texture->is_depth() ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0 + count;
    if (!texture->is_depth()) colors[count++] = at;
    glFramebufferTexture2D(GL_FRAMEBUFFER, at, GL_TEXTURE_2D, texture->name(), 0);
  }
  if (count == 0) colors[count++] = GL_NONE;
  glDrawBuffers(static_cast<GLsizei>(count), colors);
  if (colors[0] == GL_NONE) glReadBuffer(GL_NONE);
}

void Target::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, name());
  if (const GLenum state = glCheckFramebufferStatus(GL_FRAMEBUFFER); state != GL_FRAMEBUFFER_COMPLETE)
    fail_run("the OpenGL driver cannot draw into a framebuffer of this kind ({} x {} pixels, state 0x{:04x})", width(),
             height(), state);
  glViewport(0, 0, width(), height());
}

Program::Program(std::string_view vertex, std::string_view fragment) : name_(glCreateProgram()) {
  compile(name_.get(), GL_VERTEX_SHADER, vertex);
  compile(name_.get(), GL_FRAGMENT_SHADER, fragment);
  glLinkProgram(name_.get());
  GLint done = 0;
  glGetProgramiv(name_.get(), GL_LINK_STATUS, &done);
  if (!done) {
    std::string log(8192, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(name_.get(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    fail_run("the shaders {}.glsl and {}.glsl do not link:\n{}", vertex, fragment, log);
  }
  const GLuint block = glGetUniformBlockIndex(name_.get(), "Frame");
  if (block != GL_INVALID_INDEX) glUniformBlockBinding(name_.get(), block, 0);
}

void Program::use() const { glUseProgram(name_.get()); }

void Program::set(const char* name, float value) const { glUniform1f(glGetUniformLocation(name_.get(), name), value); }
void Program::set(const char* name, int value) const { glUniform1i(glGetUniformLocation(name_.get(), name), value); }
void Program::set(const char* name, float x, float y) const {
  glUniform2f(glGetUniformLocation(name_.get(), name), x, y);
}
void Program::set_pair(const char* name, int x, int y) const {
  glUniform2i(glGetUniformLocation(name_.get(), name), x, y);
}
void Program::set(const char* name, const Vec3f& v) const {
  glUniform3f(glGetUniformLocation(name_.get(), name), v.x, v.y, v.z);
}
void Program::set(const char* name, const Vec3f& v, float w) const {
  glUniform4f(glGetUniformLocation(name_.get(), name), v.x, v.y, v.z, w);
}
void Program::set(const char* name, const Mat4f& value) const {
  glUniformMatrix4fv(glGetUniformLocation(name_.get(), name), 1, GL_FALSE, value.data());
}
void Program::set_array(const char* name, const Vec3f* values, int count) const {
  glUniform3fv(glGetUniformLocation(name_.get(), name), count, &values[0].x);
}

void Program::texture(const char* name, int unit, const Texture& texture) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture.name());
  set(name, unit);
}

void ScreenTriangle::draw() const {
  array_.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace dreampm::gl
