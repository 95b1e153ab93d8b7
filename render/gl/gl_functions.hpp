// OpenGL's functions under their usual names, from the library loaded at run time:
//
//   #include "render/gl/gl_functions.hpp"
//   namespace qsmpc { void f() { glBegin(GL_QUADS); … } }
//
// Within the namespace qsmpc these names are pointers that are set when the first off-screen
// context is created. A function that is missing from the list does not link: add it there.
#pragma once

#include <GL/gl.h>

#define QSMPC_GL_FUNCTIONS(FUNCTION) \
  FUNCTION(glBegin)                  \
  FUNCTION(glBlendFunc)              \
  FUNCTION(glClear)                  \
  FUNCTION(glClearStencil)           \
  FUNCTION(glColor4f)                \
  FUNCTION(glColorMask)              \
  FUNCTION(glColorPointer)           \
  FUNCTION(glDepthFunc)              \
  FUNCTION(glDepthMask)              \
  FUNCTION(glDisable)                \
  FUNCTION(glDisableClientState)     \
  FUNCTION(glDrawArrays)             \
  FUNCTION(glDrawElements)           \
  FUNCTION(glEnable)                 \
  FUNCTION(glEnableClientState)      \
  FUNCTION(glEnd)                    \
  FUNCTION(glFinish)                 \
  FUNCTION(glFrustum)                \
  FUNCTION(glGetString)              \
  FUNCTION(glLineWidth)              \
  FUNCTION(glLoadIdentity)           \
  FUNCTION(glLoadMatrixd)            \
  FUNCTION(glMatrixMode)             \
  FUNCTION(glPointSize)              \
  FUNCTION(glPolygonMode)            \
  FUNCTION(glPolygonOffset)          \
  FUNCTION(glPopAttrib)              \
  FUNCTION(glPopMatrix)              \
  FUNCTION(glPushAttrib)             \
  FUNCTION(glPushMatrix)             \
  FUNCTION(glShadeModel)             \
  FUNCTION(glStencilFunc)            \
  FUNCTION(glStencilOp)              \
  FUNCTION(glVertex3d)               \
  FUNCTION(glVertex3dv)              \
  FUNCTION(glVertexPointer)          \
  FUNCTION(glViewport)

namespace qsmpc::render {

// A declared name cannot stand in parentheses. NOLINTNEXTLINE(bugprone-macro-parentheses)
#define QSMPC_DECLARE_GL(name) extern decltype(&::name) name;
QSMPC_GL_FUNCTIONS(QSMPC_DECLARE_GL)
#undef QSMPC_DECLARE_GL

/// Looks up an OpenGL function of a library by name; returns null if there is none.
using GlLookup = void (*(*)(const char* name))();

/// Sets the pointers above, once per process; thread-safe. Throws std::runtime_error, naming the
/// function, if `lookup` does not find one.
void load_gl_functions(GlLookup lookup);

}  // namespace qsmpc::render
