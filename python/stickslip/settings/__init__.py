"""How each analysis is computed: one class with every key, its default, bounds and meaning."""
