#pragma once

#include "raytruth/core/error.hpp"
#include "raytruth/gl/context.hpp"

#include <GL/glcorearb.h>

#include <string>

namespace raytruth {

/// The functions of OpenGL 4.3 core that passes use, loaded by the context itself.
class GlFunctions {
 public:
  /// Throws MissingError for a function that the context has not.
  explicit GlFunctions(const GlContext& context) : load_{context} {}

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
  Loader load_;

 public:
  PFNGLATTACHSHADERPROC attach_shader = load_("glAttachShader");
  PFNGLBINDBUFFERPROC bind_buffer = load_("glBindBuffer");
  PFNGLBINDBUFFERBASEPROC bind_buffer_base = load_("glBindBufferBase");
  PFNGLBINDFRAMEBUFFERPROC bind_framebuffer = load_("glBindFramebuffer");
  PFNGLBINDTEXTUREPROC bind_texture = load_("glBindTexture");
  PFNGLBINDVERTEXARRAYPROC bind_vertex_array = load_("glBindVertexArray");
  PFNGLBUFFERDATAPROC buffer_data = load_("glBufferData");
  PFNGLCHECKFRAMEBUFFERSTATUSPROC check_framebuffer_status = load_("glCheckFramebufferStatus");
  PFNGLCOMPILESHADERPROC compile_shader = load_("glCompileShader");
  PFNGLCREATEPROGRAMPROC create_program = load_("glCreateProgram");
  PFNGLCREATESHADERPROC create_shader = load_("glCreateShader");
  PFNGLDELETEBUFFERSPROC delete_buffers = load_("glDeleteBuffers");
  PFNGLDELETEFRAMEBUFFERSPROC delete_framebuffers = load_("glDeleteFramebuffers");
  PFNGLDELETEPROGRAMPROC delete_program = load_("glDeleteProgram");
  PFNGLDELETESHADERPROC delete_shader = load_("glDeleteShader");
  PFNGLDELETETEXTURESPROC delete_textures = load_("glDeleteTextures");
  PFNGLDELETEVERTEXARRAYSPROC delete_vertex_arrays = load_("glDeleteVertexArrays");
  PFNGLDISPATCHCOMPUTEPROC dispatch_compute = load_("glDispatchCompute");
  PFNGLDRAWARRAYSPROC draw_arrays = load_("glDrawArrays");
  PFNGLFRAMEBUFFERTEXTURE2DPROC framebuffer_texture_2d = load_("glFramebufferTexture2D");
  PFNGLGENBUFFERSPROC gen_buffers = load_("glGenBuffers");
  PFNGLGENFRAMEBUFFERSPROC gen_framebuffers = load_("glGenFramebuffers");
  PFNGLGENTEXTURESPROC gen_textures = load_("glGenTextures");
  PFNGLGENVERTEXARRAYSPROC gen_vertex_arrays = load_("glGenVertexArrays");
  PFNGLGETBUFFERSUBDATAPROC get_buffer_sub_data = load_("glGetBufferSubData");
  PFNGLGETERRORPROC get_error = load_("glGetError");
  PFNGLGETPROGRAMINFOLOGPROC get_program_info_log = load_("glGetProgramInfoLog");
  PFNGLGETPROGRAMIVPROC get_program = load_("glGetProgramiv");
  PFNGLGETSHADERINFOLOGPROC get_shader_info_log = load_("glGetShaderInfoLog");
  PFNGLGETSHADERIVPROC get_shader = load_("glGetShaderiv");
  PFNGLGETSTRINGPROC get_string = load_("glGetString");
  PFNGLGETUNIFORMLOCATIONPROC get_uniform_location = load_("glGetUniformLocation");
  PFNGLLINKPROGRAMPROC link_program = load_("glLinkProgram");
  PFNGLMEMORYBARRIERPROC memory_barrier = load_("glMemoryBarrier");
  PFNGLPIXELSTOREIPROC pixel_store = load_("glPixelStorei");
  PFNGLREADPIXELSPROC read_pixels = load_("glReadPixels");
  PFNGLSHADERSOURCEPROC shader_source = load_("glShaderSource");
  PFNGLACTIVETEXTUREPROC active_texture = load_("glActiveTexture");
  PFNGLTEXIMAGE1DPROC tex_image_1d = load_("glTexImage1D");
  PFNGLTEXIMAGE2DPROC tex_image_2d = load_("glTexImage2D");
  PFNGLTEXIMAGE3DPROC tex_image_3d = load_("glTexImage3D");
  PFNGLTEXPARAMETERIPROC tex_parameter = load_("glTexParameteri");
  PFNGLUNIFORM1FPROC uniform_1f = load_("glUniform1f");
  PFNGLUNIFORM1IPROC uniform_1i = load_("glUniform1i");
  PFNGLUNIFORM1UIPROC uniform_1ui = load_("glUniform1ui");
  PFNGLUNIFORM2FVPROC uniform_2fv = load_("glUniform2fv");
  PFNGLUNIFORM3FVPROC uniform_3fv = load_("glUniform3fv");
  PFNGLUNIFORM4FVPROC uniform_4fv = load_("glUniform4fv");
  PFNGLUSEPROGRAMPROC use_program = load_("glUseProgram");
  PFNGLVIEWPORTPROC viewport = load_("glViewport");
};

}  // namespace raytruth
