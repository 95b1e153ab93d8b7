// OpenGL's functions under their usual names, from the library that was loaded at run time:
//
//   #include "render/gl/gl_functions.hpp"
//   namespace qsmpc { void f() { glBegin(GL_QUADS); … } }
//
// Within the namespace qsmpc these names are pointers, which are set when the first off-screen
// context is made. A function that is missing here does not link: add it to the list.
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

/// A library's way to find a function of OpenGL by its name; null where it has none.
using GlLookup = void (*(*)(const char* name))();

/// Sets the pointers above, once in a process; thread-safe. Throws std::runtime_error, naming the
/// function, when `lookup` does not find one.
void load_gl_functions(GlLookup lookup);

}  // namespace qsmpc::render
