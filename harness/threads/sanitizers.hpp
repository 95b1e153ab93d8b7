#pragma once

// Which sanitizer the code is compiled for: QSMPC_ADDRESS_SANITIZER and QSMPC_THREAD_SANITIZER are
// 1 or 0. GCC defines a macro for it; Clang 14 only has a feature test.
#if defined(__has_feature)
#define QSMPC_HAS_FEATURE(name) __has_feature(name)
#else
#define QSMPC_HAS_FEATURE(name) 0
#endif

#if defined(__SANITIZE_ADDRESS__) || QSMPC_HAS_FEATURE(address_sanitizer)
#define QSMPC_ADDRESS_SANITIZER 1
#else
#define QSMPC_ADDRESS_SANITIZER 0
#endif

#if defined(__SANITIZE_THREAD__) || QSMPC_HAS_FEATURE(thread_sanitizer)
#define QSMPC_THREAD_SANITIZER 1
#else
#define QSMPC_THREAD_SANITIZER 0
#endif

#undef QSMPC_HAS_FEATURE
