// OpenGL's functions under their usual names, from the library that was loaded at run time:
//
//   #include "render/gl_functions.hpp"
//   namespace qsmpc { void f() { glBegin(GL_QUADS); … } }
//
// Within the namespace qsmpc these names are pointers, which are set when the first off-screen
// context is made. A function that is missing here does not link: add it to the list.
#pragma once

#include <GL/gl.h>

#define QSMPC_GL_FUNCTIONS(FUNCTION) \
  FUNCTION(glAlphaFunc)              \
  FUNCTION(glBegin)                  \
  FUNCTION(glBindTexture)            \
  FUNCTION(glBlendFunc)              \
  FUNCTION(glClear)                  \
  FUNCTION(glClearColor)             \
  FUNCTION(glClearDepth)             \
  FUNCTION(glClearStencil)           \
  FUNCTION(glColor3f)                \
  FUNCTION(glColor4f)                \
  FUNCTION(glColor4fv)               \
  FUNCTION(glColor4ub)               \
  FUNCTION(glColorMask)              \
  FUNCTION(glColorPointer)           \
  FUNCTION(glCullFace)               \
  FUNCTION(glDeleteTextures)         \
  FUNCTION(glDepthFunc)              \
  FUNCTION(glDepthMask)              \
  FUNCTION(glDepthRange)             \
  FUNCTION(glDisable)                \
  FUNCTION(glDisableClientState)     \
  FUNCTION(glDrawArrays)             \
  FUNCTION(glDrawElements)           \
  FUNCTION(glEnable)                 \
  FUNCTION(glEnableClientState)      \
  FUNCTION(glEnd)                    \
  FUNCTION(glFinish)                 \
  FUNCTION(glFlush)                  \
  FUNCTION(glFogf)                   \
  FUNCTION(glFogfv)                  \
  FUNCTION(glFogi)                   \
  FUNCTION(glFrontFace)              \
  FUNCTION(glFrustum)                \
  FUNCTION(glGenTextures)            \
  FUNCTION(glGetError)               \
  FUNCTION(glGetFloatv)              \
  FUNCTION(glGetIntegerv)            \
  FUNCTION(glGetString)              \
  FUNCTION(glHint)                   \
  FUNCTION(glInterleavedArrays)      \
  FUNCTION(glIsEnabled)              \
  FUNCTION(glLineStipple)            \
  FUNCTION(glLineWidth)              \
  FUNCTION(glLoadIdentity)           \
  FUNCTION(glLoadMatrixd)            \
  FUNCTION(glLoadMatrixf)            \
  FUNCTION(glMatrixMode)             \
  FUNCTION(glMultMatrixd)            \
  FUNCTION(glNormal3d)               \
  FUNCTION(glNormal3f)               \
  FUNCTION(glNormalPointer)          \
  FUNCTION(glOrtho)                  \
  FUNCTION(glPixelStorei)            \
  FUNCTION(glPointSize)              \
  FUNCTION(glPolygonMode)            \
  FUNCTION(glPolygonOffset)          \
  FUNCTION(glPopAttrib)              \
  FUNCTION(glPopClientAttrib)        \
  FUNCTION(glPopMatrix)              \
  FUNCTION(glPushAttrib)             \
  FUNCTION(glPushClientAttrib)       \
  FUNCTION(glPushMatrix)             \
  FUNCTION(glReadBuffer)             \
  FUNCTION(glReadPixels)             \
  FUNCTION(glRotated)                \
  FUNCTION(glScaled)                 \
  FUNCTION(glScissor)                \
  FUNCTION(glShadeModel)             \
  FUNCTION(glStencilFunc)            \
  FUNCTION(glStencilMask)            \
  FUNCTION(glStencilOp)              \
  FUNCTION(glTexCoord2f)             \
  FUNCTION(glTexCoordPointer)        \
  FUNCTION(glTexEnvi)                \
  FUNCTION(glTexImage2D)             \
  FUNCTION(glTexParameteri)          \
  FUNCTION(glTranslated)             \
  FUNCTION(glVertex2d)               \
  FUNCTION(glVertex2f)               \
  FUNCTION(glVertex3d)               \
  FUNCTION(glVertex3dv)              \
  FUNCTION(glVertex3f)               \
  FUNCTION(glVertex3fv)              \
  FUNCTION(glVertexPointer)          \
  FUNCTION(glViewport)

namespace qsmpc {

// A declared name cannot stand in parentheses. NOLINTNEXTLINE(bugprone-macro-parentheses)
#define QSMPC_DECLARE_GL(name) extern decltype(&::name) name;
QSMPC_GL_FUNCTIONS(QSMPC_DECLARE_GL)
#undef QSMPC_DECLARE_GL

/// A library's way to find a function of OpenGL by its name; null where it has none.
using GlLookup = void (*(*)(const char* name))();

/// Sets the pointers above, once in a process; thread-safe. Throws std::runtime_error, naming the
/// function, when `lookup` does not find one.
void load_gl_functions(GlLookup lookup);

}  // namespace qsmpc
