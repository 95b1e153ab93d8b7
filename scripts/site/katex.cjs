// Renders formulas with KaTeX: a line of JSON {"tex": …, "display": …} in, a line {"html": …} or {"error": …} out.
const katex = require('/usr/share/javascript/katex/katex.min.js');
const readline = require('node:readline');

readline.createInterface({input: process.stdin}).on('line', line => {
  const {tex, display} = JSON.parse(line);
  let answer;
  try {
    answer = {html: katex.renderToString(tex, {displayMode: display, throwOnError: true, strict: 'ignore'})};
  } catch (error) {
    answer = {error: error.message};
  }
  process.stdout.write(JSON.stringify(answer) + '\n');
});
