#pragma once

#include "core/error.hpp"
#include "gl/context.hpp"

#include <GL/glcorearb.h>

#include <string>

namespace raytruth {

/// The functions of OpenGL 4.3 core that passes use, loaded by the context itself.
class GlFunctions {
 public:
  /// Throws MissingError for a function that the context has not.
  explicit GlFunctions(const GlContext& context) : load{context} {}

 private:
  /// A function of yet unknown type, which its pointer knows.
  struct Untyped {
    GlContext::Address address;
    template <class Function>
    operator Function() const {  // NOLINT(google-explicit-constructor)
      return reinterpret_cast<Function>(address);
    }
  };
  struct Loader {
    const GlContext& context;
    Untyped operator()(const char* name) const {
      const auto address = context.find(name);
      if (address == nullptr) throw MissingError(std::string("this OpenGL has no ") + name);
      return {address};
    }
  };
  Loader load;

 public:
  PFNGLATTACHSHADERPROC attach_shader = load("glAttachShader");
  PFNGLBINDBUFFERPROC bind_buffer = load("glBindBuffer");
  PFNGLBINDBUFFERBASEPROC bind_buffer_base = load("glBindBufferBase");
  PFNGLBINDFRAMEBUFFERPROC bind_framebuffer = load("glBindFramebuffer");
  PFNGLBINDTEXTUREPROC bind_texture = load("glBindTexture");
  PFNGLBINDVERTEXARRAYPROC bind_vertex_array = load("glBindVertexArray");
  PFNGLBUFFERDATAPROC buffer_data = load("glBufferData");
  PFNGLCHECKFRAMEBUFFERSTATUSPROC check_framebuffer_status = load("glCheckFramebufferStatus");
  PFNGLCOMPILESHADERPROC compile_shader = load("glCompileShader");
  PFNGLCREATEPROGRAMPROC create_program = load("glCreateProgram");
  PFNGLCREATESHADERPROC create_shader = load("glCreateShader");
  PFNGLDELETEBUFFERSPROC delete_buffers = load("glDeleteBuffers");
  PFNGLDELETEFRAMEBUFFERSPROC delete_framebuffers = load("glDeleteFramebuffers");
  PFNGLDELETEPROGRAMPROC delete_program = load("glDeleteProgram");
  PFNGLDELETESHADERPROC delete_shader = load("glDeleteShader");
  PFNGLDELETETEXTURESPROC delete_textures = load("glDeleteTextures");
  PFNGLDELETEVERTEXARRAYSPROC delete_vertex_arrays = load("glDeleteVertexArrays");
  PFNGLDISPATCHCOMPUTEPROC dispatch_compute = load("glDispatchCompute");
  PFNGLDRAWARRAYSPROC draw_arrays = load("glDrawArrays");
  PFNGLFRAMEBUFFERTEXTURE2DPROC framebuffer_texture_2d = load("glFramebufferTexture2D");
  PFNGLGENBUFFERSPROC gen_buffers = load("glGenBuffers");
  PFNGLGENFRAMEBUFFERSPROC gen_framebuffers = load("glGenFramebuffers");
  PFNGLGENTEXTURESPROC gen_textures = load("glGenTextures");
  PFNGLGENVERTEXARRAYSPROC gen_vertex_arrays = load("glGenVertexArrays");
  PFNGLGETBUFFERSUBDATAPROC get_buffer_sub_data = load("glGetBufferSubData");
  PFNGLGETERRORPROC get_error = load("glGetError");
  PFNGLGETPROGRAMINFOLOGPROC get_program_info_log = load("glGetProgramInfoLog");
  PFNGLGETPROGRAMIVPROC get_program = load("glGetProgramiv");
  PFNGLGETSHADERINFOLOGPROC get_shader_info_log = load("glGetShaderInfoLog");
  PFNGLGETSHADERIVPROC get_shader = load("glGetShaderiv");
  PFNGLGETSTRINGPROC get_string = load("glGetString");
  PFNGLGETUNIFORMLOCATIONPROC get_uniform_location = load("glGetUniformLocation");
  PFNGLLINKPROGRAMPROC link_program = load("glLinkProgram");
  PFNGLMEMORYBARRIERPROC memory_barrier = load("glMemoryBarrier");
  PFNGLPIXELSTOREIPROC pixel_store = load("glPixelStorei");
  PFNGLREADPIXELSPROC read_pixels = load("glReadPixels");
  PFNGLSHADERSOURCEPROC shader_source = load("glShaderSource");
  PFNGLACTIVETEXTUREPROC active_texture = load("glActiveTexture");
  PFNGLTEXIMAGE1DPROC tex_image_1d = load("glTexImage1D");
  PFNGLTEXIMAGE2DPROC tex_image_2d = load("glTexImage2D");
  PFNGLTEXIMAGE3DPROC tex_image_3d = load("glTexImage3D");
  PFNGLTEXPARAMETERIPROC tex_parameter = load("glTexParameteri");
  PFNGLUNIFORM1FPROC uniform_1f = load("glUniform1f");
  PFNGLUNIFORM1IPROC uniform_1i = load("glUniform1i");
  PFNGLUNIFORM1UIPROC uniform_1ui = load("glUniform1ui");
  PFNGLUNIFORM2FVPROC uniform_2fv = load("glUniform2fv");
  PFNGLUNIFORM3FVPROC uniform_3fv = load("glUniform3fv");
  PFNGLUNIFORM4FVPROC uniform_4fv = load("glUniform4fv");
  PFNGLUSEPROGRAMPROC use_program = load("glUseProgram");
  PFNGLVIEWPORTPROC viewport = load("glViewport");
};

}  // namespace raytruth
