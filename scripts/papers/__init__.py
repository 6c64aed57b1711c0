"""What scripts/make_papers writes: for each paper its figures beside ours, and the words around."""
