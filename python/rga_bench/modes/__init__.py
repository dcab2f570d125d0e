"""What natural frequencies cost, beside other solvers on the same structures."""
