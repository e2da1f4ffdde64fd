"""The engine: bodies, joints and elastic elements over a tree; Y = B v and Bᵀ as sweeps, and elimination."""
