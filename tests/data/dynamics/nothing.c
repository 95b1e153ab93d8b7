/* A shared library with nothing in it that qsmpc looks for. */
int qsmpc_test_nothing(void);
int qsmpc_test_nothing(void) { return 0; }
