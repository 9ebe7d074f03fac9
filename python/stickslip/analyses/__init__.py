"""One file per analysis; each is one function of a model that returns an immutable result."""
