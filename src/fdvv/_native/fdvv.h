/* What the compiled library offers to Python. All arrays are C-contiguous doubles owned by the caller. */
#ifndef FDVV_H
#define FDVV_H

#endif
