"""Questions of speed and accuracy, each answered by a module that prints its figures."""
