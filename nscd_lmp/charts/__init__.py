"""Work-precision charts: seconds per simulated second against physical errors."""
