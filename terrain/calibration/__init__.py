"""A camera's lens from photographs of a chessboard, its mount from marked points or from a run."""
