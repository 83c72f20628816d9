mod formulas;
mod glass;
