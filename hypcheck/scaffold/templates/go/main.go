// The door between hypcheck and predicate.go: questions on standard input, answers on standard output.
//
//	@BUILD@
//
// docs/protocol.md of hypcheck says what is spoken. Nothing here changes when the predicate does.
package main

import (
	"bufio"
	"encoding/binary"
	"errors"
	"fmt"
	"io"
	"math"
	"os"
	"strconv"
	"strings"
	"time"
)

const (
@position@
	mostColumns = 10
@passage@
	mostColumns = 13
@end@
	most        = 65536
)

@position@
// row holds alpha, gamma, b, d, x, y, z, and the axis if the predicate claims "tilt":true.
@passage@
// row holds alpha, gamma, b, d, x0, y0, z0, x1, y1, z1, and the axis if the predicate claims "tilt":true.
@end@
type row [mostColumns]float64

var (
	tilt        = strings.Contains(description, `"tilt":true`)
@position@
	columns     = 7
	textForm    = "text"
	binaryForm  = "binary"
	errQuestion = errors.New("the question is not understood")
	errRow      = errors.New("a row is not seven decimals")
@passage@
	times       = strings.Contains(description, `"times":true`)
	columns     = 10
	textForm    = "passage-text"
	binaryForm  = "passage-binary"
	errQuestion = errors.New("the question is not understood")
	errRow      = errors.New("a row is not ten decimals")
@end@
	errEnd      = errors.New("the input ended within the rows")
)

func init() {
	if tilt {
@position@
		columns, textForm, binaryForm = mostColumns, "tilted-text", "tilted-binary"
		errRow = errors.New("a row is not ten decimals")
@passage@
		columns = mostColumns
		errRow = errors.New("a row is not thirteen decimals")
@end@
	}
}

func parseRow(line string) (numbers row, err error) {
	words := strings.Fields(line)
	if len(words) != columns {
		return numbers, errRow
	}
	for column, word := range words {
		if numbers[column], err = strconv.ParseFloat(word, 64); err != nil {
			return numbers, errRow
		}
	}
	return numbers, nil
}

// readText reads to the last line before it complains, so that the next question is found.
func readText(input *bufio.Reader, n int) (rows []row, trouble error) {
	rows = make([]row, n)
	for i := range rows {
		line, err := input.ReadString('\n')
		if err != nil && line == "" {
			return nil, errEnd
		}
		if rows[i], err = parseRow(line); err != nil {
			trouble = err
		}
	}
	return rows, trouble
}

func readBinary(input io.Reader, n int) ([]row, error) {
	bytes := make([]byte, 8*columns*n)
	if _, err := io.ReadFull(input, bytes); err != nil {
		return nil, errEnd
	}
	rows := make([]row, n)
	for i := range rows {
		for column := 0; column < columns; column++ {
			rows[i][column] = math.Float64frombits(binary.LittleEndian.Uint64(bytes[8*(columns*i+column):]))
		}
	}
	return rows, nil
}

@position@
func positions(rows []row, answers []int8) {
@passage@
// passages writes the times of first contact, negative where there is none.
func passages(rows []row, first []float64) {
@end@
	for i, r := range rows {
		if tilt {
@position@
			answers[i] = tilted(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9])
@passage@
			first[i] = tilted(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9], r[10], r[11], r[12])
@end@
			continue
		}
@position@
		answers[i] = predicate(r[0], r[1], r[2], r[3], r[4], r[5], r[6])
@passage@
		first[i] = predicate(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9])
@end@
	}
}

@position@
func classify(sequence string, rows []row, text bool) []byte {
	answers := make([]int8, len(rows))
	positions(rows, answers)
	reply := []byte(fmt.Sprintf("%s %d\n", sequence, len(rows)))
	for _, answer := range answers {
		if text {
			reply = append(strconv.AppendInt(reply, int64(answer), 10), '\n')
		} else {
			reply = append(reply, byte(answer))
@passage@
func hit(time float64) int {
	if time >= 0 {
		return 1
	}
	return 0
}

func classify(sequence string, rows []row, text bool) []byte {
	first := make([]float64, len(rows))
	passages(rows, first)
	reply := []byte(fmt.Sprintf("%s %d\n", sequence, len(rows)))
	for _, time := range first {
		if !text {
			reply = append(reply, byte(hit(time)))
			continue
		}
		reply = strconv.AppendInt(reply, int64(hit(time)), 10)
		if times && hit(time) == 1 {
			reply = strconv.AppendFloat(append(reply, ' '), time, 'g', -1, 64)
		}
		reply = append(reply, '\n')
	}
	if times && !text {
		for _, time := range first {
			reply = binary.LittleEndian.AppendUint64(reply, math.Float64bits(time))
@end@
		}
	}
	return reply
}

func timed(sequence string, rows []row, repeat int) []byte {
@position@
	answers := make([]int8, len(rows))
@passage@
	first := make([]float64, len(rows))
@end@
	start := time.Now()
	for i := 0; i < repeat; i++ {
@position@
		positions(rows, answers)
@passage@
		passages(rows, first)
@end@
	}
	took := time.Since(start)
	checksum := 0
@position@
	for _, answer := range answers {
		checksum += int(answer)
@passage@
	for _, time := range first {
		checksum += hit(time)
@end@
	}
	return []byte(fmt.Sprintf("%s %d %d\n", sequence, took.Nanoseconds(), checksum))
}

// count is a whole number from least to greatest.
func count(word string, least, greatest uint64) (int, error) {
	number, err := strconv.ParseUint(word, 10, 64)
	if err != nil || number < least || number > greatest {
		return 0, errQuestion
	}
	return int(number), nil
}

// answer reads the rest of a question whose first line is given, and returns the reply.
func answer(line string, input *bufio.Reader) ([]byte, error) {
	words := strings.Fields(line)
	if len(words) < 4 {
		return nil, errQuestion
	}
	sequence, rest := words[1], words[3:]
	n, err := count(words[2], 0, most)
	if _, trouble := count(sequence, 0, math.MaxUint64); trouble != nil || err != nil {
		return nil, errQuestion
	}
	var rows []row
	switch {
	case words[0] == "classify" && len(rest) == 1 && rest[0] == textForm:
		if rows, err = readText(input, n); err != nil {
			return nil, err
		}
		return classify(sequence, rows, true), nil
	case words[0] == "classify" && len(rest) == 1 && rest[0] == binaryForm:
		if rows, err = readBinary(input, n); err != nil {
			return nil, err
		}
		return classify(sequence, rows, false), nil
	case words[0] == "time" && len(rest) == 2 && rest[1] == binaryForm:
		repeat, err := count(rest[0], 1, 999_999_999)
		if err != nil {
			return nil, err
		}
		if rows, err = readBinary(input, n); err != nil {
			return nil, err
		}
		return timed(sequence, rows, repeat), nil
	}
	return nil, errQuestion
}

func main() {
	input := bufio.NewReaderSize(os.Stdin, 1<<16)
	fmt.Println(description)
	for {
		line, err := input.ReadString('\n')
		if err != nil && line == "" {
			return
		}
		reply, trouble := answer(line, input)
		if trouble != nil {
			reply = []byte("error " + trouble.Error() + "\n")
		}
		if _, err := os.Stdout.Write(reply); err != nil {
			return
		}
	}
}
